package skein.record

import java.nio.file.{Files, Path}
import skein.mcap.{Bytes, McapWriter, TopicMessage, Record as McapRecord}
import skein.mcap.file.McapFile
import scala.collection.immutable.VectorMap
import skein.testing.TemporaryFolders
import skein.units.Instant

class McapRecordingSuite extends munit.FunSuite, TemporaryFolders:

  private def recorded(folder: Path): Path =
    val file     = folder.resolve("flight.duckdb")
    val recorder = MemoryRecorder(Samples.heading)
    Samples.oneOfEach.foreach(recorder.offer)
    assert(recorder.writeTo(file).isRight)
    file

  private def exported(folder: Path): Path =
    val mcap = folder.resolve("flight.mcap")
    assertEquals(McapRecording.write(recorded(folder), mcap), Right(()))
    mcap

  private def messages(mcap: Path, topic: String): Vector[TopicMessage] =
    McapFile.read(mcap, _.channel.topic == topic)(_.map(_.fold(e => fail(e.message), identity)).toVector)

  private def records(mcap: Path): Vector[McapRecord] =
    McapFile.stream(mcap)(_.map(_.fold(e => fail(e.message), _.record)).toVector)

  folder.test("an exported and imported recording is unchanged, with an equal digest"): folder =>
    val again = folder.resolve("again.duckdb")
    assertEquals(McapRecording.read(exported(folder), again), Right(()))
    assertEquals(RecordingReader.read(again), Right(Recording(Samples.heading, Samples.oneOfEach)))
    assertEquals(
      RecordingReader.records(again).map(_.map(_._2)),
      Right(Samples.heading.records.toVector ++ Samples.oneOfEach)
    )
    assertEquals(Digest.ofFile(again), Digest.ofFile(folder.resolve("flight.duckdb")))
    assertEquals(Files.list(folder).count(), 3L)

  folder.test("an export of format 6 is imported with the values that its texts contain"): folder =>
    val today = exported(folder)
    val older = folder.resolve("older.mcap")
    McapFile.write(older, McapRecording.options): mcap =>
      mcap.metadata("skein", VectorMap("format" -> "6"))
      for table <- Seq("flight", "event", "acknowledgement") do
        val channel = mcap.channel(s"/skein/$table", "json", 0)
        for one <- messages(today, s"/skein/$table") do
          val row = ujson.read(one.message.data.utf8).obj
          for error <- row.remove("error") if !error.isNull do row("outcome") = error
          for added <- Seq("about", "count", "scenarioName") do row.remove(added): Unit
          mcap.message(channel, 0, one.message.logTime, one.message.publishTime, Bytes.utf8(ujson.write(row)))
    assertEquals(McapRecording.read(older, folder.resolve("again.duckdb")), Right(()))
    val again = RecordingReader.read(folder.resolve("again.duckdb"))
    val known = Recording(Samples.heading, Samples.oneOfEach)
    // Not their times, which `ujson` reads as doubles.
    def told(recording: Recording) = (
      recording.events.map(_.copy(at = Instant.Epoch)),
      recording.acknowledgements.map(_.copy(endedAt = Instant.Epoch)),
      recording.flight.copy(startedAt = Instant.Epoch)
    )
    assertEquals(again.map(told), Right(told(known)))

  folder.test("every table is a topic whose schema lists its columns"): folder =>
    val mcap   = exported(folder)
    val topics = records(mcap).collect { case channel: McapRecord.Channel => channel.topic }.toSet
    assertEquals(Table.all.map(table => s"/skein/${table.name}").toSet.diff(topics), Set.empty[String])
    val decision = messages(mcap, "/skein/decision").head
    val schema   = decision.schema.get.data.utf8
    assert(schema.contains(""""ownTrueAgeMs":{"type":"number"}"""), schema)
    assert(decision.message.data.utf8.startsWith("""{"row":"""), decision.message.data.utf8)

  folder.test(
    "viewers can read every schema: a field has one known type, and an object has its properties"
  ): folder =>
    def refused(at: String, schema: ujson.Value): Vector[String] = schema("type") match
      case ujson.Str("object") =>
        schema.obj.get("properties").fold(Vector(s"$at has no properties"))(
          _.obj.toVector.flatMap((name, field) => refused(s"$at.$name", field))
        )
      case ujson.Str("array")                                     => refused(s"$at[]", schema("items"))
      case ujson.Str("number" | "integer" | "string" | "boolean") => Vector.empty
      case other                                                  => Vector(s"$at is of type $other")
    val (binary, schemas) = records(exported(folder))
      .collect { case schema: McapRecord.Schema => schema }
      .distinct
      .partition(_.encoding == "protobuf")
    assertEquals(schemas.size, Table.all.size + FoxgloveSchemas.all.size)
    assertEquals(binary.map(_.name).toSet, Set("foxglove.RawImage", "foxglove.PointCloud"))
    assertEquals(schemas.flatMap(one => refused(one.name, ujson.read(one.data.utf8))), Vector.empty)

  folder.test(
    "a log time is when the controller learned a fact; a publish time is when the fact was made or sent"
  ): folder =>
    val mcap                 = exported(folder)
    def times(table: String) =
      messages(mcap, s"/skein/$table").map(found => (found.message.logTime, found.message.publishTime)).head
    val reading  = Samples.oneOfEach.collectFirst { case one: ReadingRow => one }.get
    val latency  = Samples.oneOfEach.collectFirst { case one: Latency => one }.get
    val guess    = Samples.oneOfEach.collectFirst { case one: Prediction => one }.get
    val received = reading.state.receivedAt.toNanos
    assertEquals(times("reading"), (received, received))
    assertEquals(times("latency"), ((latency.sentAt + latency.roundTrip).toNanos, latency.sentAt.toNanos))
    assertEquals(times("prediction")._2, guess.madeAt.toNanos)

  folder.test("viewers get poses, frames, events and a scene by Foxglove's schemas"): folder =>
    val mcap = exported(folder)
    val pose = messages(mcap, "/vehicles/Pursuer/pose").head
    assertEquals(pose.schema.map(_.name), Some("foxglove.PoseInFrame"))
    val reading = Samples.oneOfEach.collectFirst { case one: ReadingRow => one }.get
    val at      = reading.state.value.positionNed
    assert(
      pose.message.data.utf8.contains(s""""position":{"x":${at.x},"y":${at.y},"z":${at.z}}"""),
      pose.message.data.utf8
    )
    val frames =
      messages(mcap, "/tf_static").map(_.message.data.utf8) ++ messages(mcap, "/tf").map(_.message.data.utf8)
    assert(frames.head.contains(""""parent_frame_id":"world","child_frame_id":"world_ned""""), frames.head)
    assert(frames.exists(_.contains(""""child_frame_id":"Pursuer"""")))
    assertEquals(messages(mcap, "/vehicles/Evader/body").size, 1)
    assert(messages(mcap, "/log").head.message.data.utf8.contains(""""level":3"""))

  folder.test("pixels and points are in the message after their row, and a row without them is refused"):
    folder =>
      val mcap  = exported(folder)
      val found = messages(mcap, "/vehicles/Pursuer/front_center/image")
      assertEquals(found.map(_.schema.map(_.name)), Vector.fill(2)(Some("foxglove.RawImage")))
      assertEquals(
        found.flatMap(one => Protobuf.bytesOf(one.message.data, 6)).map(bytes => Blob.of(bytes.toArray)),
        Vector(1L, 2L).map(Samples.image(_).pixels)
      )
      assert(!messages(mcap, "/skein/image").head.message.data.utf8.contains("pixels"))
      val cut = folder.resolve("cut.mcap")
      McapFile.write(cut)(out =>
        out.message(out.channel("/skein/image", "json"), 0, 0, 0, Bytes.utf8("""{"row":1}"""))
      )
      val error = McapRecording.read(cut, folder.resolve("again.duckdb")).left.map(_.message)
      assert(error.left.exists(_.contains("""no bytes behind its row: {"row":1}""")), error)

  folder.test("a trail of the last twenty seconds is shown once a second"): folder =>
    val file     = folder.resolve("long.duckdb")
    val mcap     = folder.resolve("long.mcap")
    val recorder = MemoryRecorder(Samples.heading)
    // Ten a second.
    (1L to 300).foreach(sequence => recorder.offer(Samples.reading(sequence)))
    assert(recorder.writeTo(file).isRight)
    assertEquals(McapRecording.write(file, mcap), Right(()))
    val trails = messages(mcap, "/vehicles/Pursuer/trail").map(found => ujson.read(found.message.data.utf8))
    val points = trails.map(_("entities")(0)("lines")(0)("points").arr.map(_("x").num))
    assertEquals(points.map(_.size), (1 to 29).map(second => (second * 10 + 1).min(201)).toVector)
    assertEquals((points.last.head, points.last.last), (91.1, 291.1))

  folder.test("a file that is not an exported recording is refused, and leaves no output behind"): folder =>
    val mcap                                        = exported(folder)
    val again                                       = folder.resolve("again.duckdb")
    def refused(change: McapWriter => Unit): String =
      McapFile.write(mcap)(change)
      val error = McapRecording.read(mcap, again).left.map(_.message).swap.getOrElse("it was read")
      assertEquals(Files.list(folder).count(), 2L, error)
      error
    assert(refused(_ => ()).endsWith("is not an exported recording: its table 'flight' is empty"))
    assert(
      refused(out => out.message(out.channel("/skein/x", "json"), 0, 0, 0, Bytes.empty))
        .endsWith("its topic /skein/x is none of a recording's tables")
    )
    val half =
      refused(out => out.message(out.channel("/skein/event", "json"), 0, 0, 0, Bytes.utf8("""{"row": 1}""")))
    assert(half.contains("is not an exported recording: "), half)

  folder.test("the error for a truncated export states the truncation"): folder =>
    val mcap = exported(folder)
    Files.write(mcap, Files.readAllBytes(mcap).dropRight(100))
    val error = McapRecording.read(mcap, folder.resolve("again.duckdb")).left.map(_.message)
    assert(error.left.exists(_.contains("the file is cut off")), error)

  folder.test("a recording is never overwritten"): folder =>
    val mcap  = exported(folder)
    val there = folder.resolve("flight.duckdb")
    assertEquals(McapRecording.read(mcap, there), Left(RecordError.AlreadyExists(there)))

  test("texts are written according to the rules of JSON"):
    assertEquals(Json.string("a\"b\\c\n\u0001é🛸"), "\"a\\\"b\\\\c\\u000a\\u0001é\\ud83d\\udef8\"")
