package skein.record

import java.nio.file.{Files, Path}
import java.sql.DriverManager
import scala.util.Using
import skein.testing.TemporaryFolders

class RecordingSuite extends munit.FunSuite, TemporaryFolders:

  private def record(file: Path, records: Record*): Unit =
    val recorder = MemoryRecorder(Samples.heading)
    records.foreach(recorder.offer)
    val written = recorder.writeTo(file)
    assert(written.isRight, written)

  private def execute(file: Path, sql: String): Unit =
    Using.resource(DriverManager.getConnection(s"jdbc:duckdb:$file")): connection =>
      val _ = connection.createStatement().execute(sql)

  folder.test("every record is read from the file as it was offered"): folder =>
    val file = folder.resolve("flight.duckdb")
    record(file, Samples.oneOfEach*)
    assertEquals(RecordingReader.read(file), Right(Recording(Samples.heading, Samples.oneOfEach)))

  folder.test("a file of the previous format is read, and values that it lacks are absent"): folder =>
    val file = folder.resolve("flight.duckdb")
    record(file, Samples.oneOfEach*)
    execute(file, "DROP TABLE sighting")
    execute(file, "ALTER TABLE decision DROP COLUMN speedMps")
    execute(file, "UPDATE format SET version = 2")
    val older = Samples.oneOfEach.collect:
      case decision: DecisionRow                  => decision.copy(speed = None)
      case other if !other.isInstanceOf[Sighting] => other
    assertEquals(RecordingReader.read(file), Right(Recording(Samples.heading, older)))
    assert(Export.parquet(file, folder.resolve("parquet")).isRight)

  folder.test("slices as text, and fallback decisions in events' texts, are read from files of format 4"):
    folder =>
      val file = folder.resolve("flight.duckdb")
      record(file, Samples.oneOfEach*)
      val today = Digest.ofFile(file)
      execute(file, "ALTER TABLE event DROP COLUMN decision")
      execute(file, "ALTER TABLE plan ALTER slices TYPE VARCHAR USING array_to_string(slices, ',')")
      execute(file, "UPDATE format SET version = 4")
      assertEquals(RecordingReader.read(file), Right(Recording(Samples.heading, Samples.oneOfEach)))
      assertEquals(Digest.ofFile(file), today)

  folder.test("outcomes, event subjects and simulators are read from the texts in files of format 6"):
    folder =>
      val file = folder.resolve("flight.duckdb")
      record(file, Samples.oneOfEach*)
      val today = Digest.ofFile(file)
      execute(file, "UPDATE acknowledgement SET outcome = error WHERE error IS NOT NULL")
      execute(file, "ALTER TABLE acknowledgement DROP COLUMN error")
      execute(file, "ALTER TABLE event DROP COLUMN about")
      execute(file, "ALTER TABLE event DROP COLUMN count")
      execute(file, "ALTER TABLE flight DROP COLUMN scenarioName")
      execute(file, "UPDATE flight SET simulator = 'built-in, MAVLink, mujoco:quadrotor.xml'")
      execute(file, "UPDATE format SET version = 6")
      assertEquals(RecordingReader.read(file), Right(Recording(Samples.heading, Samples.oneOfEach)))
      assertEquals(Digest.ofFile(file), today)
      execute(file, "UPDATE flight SET scenario = 'duel, as published, pursuer pure-pursuit'")
      assertEquals(RecordingReader.read(file).map(_.flight.nameOfScenario), Right("duel"))

  folder.test("a table of a later format may be missing, but no table of the file's own format"): folder =>
    val file = folder.resolve("flight.duckdb")
    record(file, Samples.oneOfEach*)
    for
      // Images and clouds are read only on request.
      (table, came) <-
        Seq("solved" -> 6, "sensing" -> 5, "measurement" -> 5, "ending" -> 4, "plan" -> 3, "sighting" -> 3)
      _ = execute(file, s"DROP TABLE $table")
      format <- Seq(came, came - 1)
    do
      execute(file, s"UPDATE format SET version = $format")
      RecordingReader.read(file) match
        case Right(_) => assert(format < came, s"no $table in format $format")
        case Left(RecordError.NotARecording(`file`, why)) =>
          assert(format >= came, s"$table in format $format: $why")
          assert(why.contains(table), why)
        case other => fail(s"expected a recording or NotARecording, got $other")

  folder.test("a required number cannot be null, and its missing column is reported"): folder =>
    val file = folder.resolve("flight.duckdb")
    record(file, Samples.oneOfEach*)
    for column <- Seq("positionNorthM", "sequence", "vehicle") do
      val refused =
        intercept[java.sql.SQLException](execute(file, s"UPDATE reading SET $column = NULL"))
      assert(refused.getMessage.contains("NOT NULL"), refused.getMessage)
    execute(file, "ALTER TABLE reading DROP COLUMN positionNorthM")
    RecordingReader.read(file) match
      case Left(RecordError.NotARecording(`file`, why)) => assert(why.contains("positionNorthM"), why)
      case other                                        => fail(s"expected NotARecording, got $other")

  folder.test("rows are numbered across all tables, in the order of their records"): folder =>
    val file = folder.resolve("flight.duckdb")
    record(file, Samples.reading(1), Samples.decision(1), Samples.reading(2))
    Using.resource(DriverManager.getConnection(s"jdbc:duckdb:$file")): connection =>
      val rows = connection
        .createStatement()
        .executeQuery("SELECT row FROM reading UNION ALL SELECT row FROM decision ORDER BY row")
      assertEquals(
        List.unfold(rows)(rows => Option.when(rows.next())(rows.getLong(1), rows)),
        List(4L, 5L, 6L)
      )

  folder.test(
    "a recording in a folder of any name is written, exported and imported, or refused immediately"
  ): folder =>
    val odd  = Files.createDirectories(folder.resolve("-md:a=b 'c' \"d\" #e%20~f*[g]$h "))
    val file = odd.resolve("flight.duckdb")
    record(file, Samples.oneOfEach*)
    assert(Files.exists(file))
    assert(Export.parquet(file, odd.resolve("parquet")).isRight)
    assertEquals(McapRecording.write(file, odd.resolve("flight.mcap")), Right(()))
    assertEquals(McapRecording.read(odd.resolve("flight.mcap"), odd.resolve("again.duckdb")), Right(()))
    assert(Files.exists(odd.resolve("again.duckdb")))
    for name <- Seq("a\\b", "a?b", "a;b") do
      val here    = Files.createDirectories(folder.resolve(name))
      val refused = MemoryRecorder(Samples.heading).writeTo(here.resolve("flight.duckdb"))
      assert(clue(refused).left.exists(_.message.contains("expected a path without ';', '?' or '\\'")), name)
      val imported = McapRecording.read(odd.resolve("flight.mcap"), here.resolve("again.duckdb"))
      assert(clue(imported).left.exists(_.message.contains("expected a path without")), name)
      assertEquals(here.toFile.list.toSeq, Nil, name)

  folder.test("a recording is never overwritten"): folder =>
    val file = folder.resolve("flight.duckdb")
    record(file)
    assertEquals(MemoryRecorder(Samples.heading).writeTo(file), Left(RecordError.AlreadyExists(file)))

  folder.test("a file in a folder that does not exist cannot be created"): folder =>
    val file = folder.resolve("missing/flight.duckdb")
    MemoryRecorder(Samples.heading).writeTo(file) match
      case Left(RecordError.CannotCreate(`file`, _)) => ()
      case other                                     => fail(s"expected CannotCreate, got $other")

  folder.test("a file that is not a recording is refused with the reason"): folder =>
    val missing = folder.resolve("missing.duckdb")
    assertEquals(RecordingReader.read(missing), Left(RecordError.NoSuchFile(missing)))
    val text = Files.writeString(folder.resolve("text.duckdb"), "position,velocity\n1,2\n")
    assertEquals(RecordingReader.read(text), Left(RecordError.NotARecording(text, "it is not a DuckDB file")))
    val other = folder.resolve("other.duckdb")
    execute(other, "CREATE TABLE anything (x INTEGER)")
    assertEquals(
      RecordingReader.read(other),
      Left(RecordError.NotARecording(other, "it has no table 'format'"))
    )

  folder.test("the error for a recording of another format states both formats"): folder =>
    val file = folder.resolve("flight.duckdb")
    record(file)
    execute(file, "UPDATE format SET version = 99")
    assertEquals(
      RecordingReader.read(file),
      Left(RecordError.OtherVersion(file, RecordingFormat.oldest, RecordingFormat.version, 99))
    )

  for (what, change, reason) <- Seq(
      (
        "a number that is none",
        "UPDATE reading SET positionNorthM = 'NaN'",
        "table reading, row 4: positionNorthM: expected a finite number, got NaN"
      ),
      (
        "an endless number",
        "UPDATE decision SET ownAgeMs = '-Infinity'",
        "table decision, row 5: ownAgeMs: expected a finite number, got -Infinity"
      ),
      (
        "an unknown word",
        "UPDATE event SET kind = 'Odd'",
        "table event, row 6: kind: expected one of Dropped, Skipped"
      )
    )
  do
    folder.test(s"$what in a recording is reported with its place, in one line"): folder =>
      val file = folder.resolve("flight.duckdb")
      record(
        file,
        Samples.reading(1),
        Samples.decision(1),
        Event(Samples.at(6), EventKind.Skipped, None, "late")
      )
      execute(file, change)
      RecordingReader.read(file) match
        case Left(RecordError.NotARecording(`file`, found)) =>
          assert(found.startsWith(reason), found)
          assertEquals(found.linesIterator.size, 1)
        case other => fail(s"expected NotARecording, got $other")

  folder.test("each table is exported as a Parquet file with all its rows"): folder =>
    val file      = folder.resolve("flight.duckdb")
    val directory = folder.resolve("it's parquet")
    record(file, Samples.oneOfEach*)
    val files = Export.parquet(file, directory).fold(error => fail(error.message), identity)
    assertEquals(files.map(_.getFileName.toString).toSet, Table.all.map(_.name + ".parquet").toSet)
    Using.resource(DriverManager.getConnection("jdbc:duckdb:")): connection =>
      val quoted = directory.resolve("decision.parquet").toString.replace("'", "''")
      val rows = connection.createStatement().executeQuery(s"SELECT count(*), sum(headingRad) FROM '$quoted'")
      assert(rows.next())
      assertEquals(rows.getInt(1), 2)
      assertEqualsDouble(rows.getDouble(2), 2 * 0.9776, 1e-12)

  folder.test("the error of a failed export states the recording and the target"): folder =>
    val file  = folder.resolve("flight.duckdb")
    val taken = java.nio.file.Files.writeString(folder.resolve("taken"), "")
    record(file, Samples.oneOfEach*)
    val told = Export.parquet(file, taken).left.map(_.message)
    assert(clue(told).left.exists(_.startsWith(s"cannot export $file to $taken: ")))

  test("a recorder in memory fails when it is full instead of dropping silently"):
    val recorder = MemoryRecorder(Samples.heading, capacity = 2)
    Samples.oneOfEach.take(2).foreach(recorder.offer)
    assert(!recorder.failure.isCompleted)
    recorder.offer(Samples.reading(3))
    assertEquals(recorder.failure.value.map(_.get), Some(RecordError.MemoryFull(2)))
    assertEquals(recorder.close().value.map(_.get), Some(Left(RecordError.MemoryFull(2))))
    recorder.offer(Samples.reading(4))
    assertEquals(recorder.records, Samples.oneOfEach.take(2))
    val ending = Ending(Samples.at(1), EndingKind.Failed, Some("full"))
    recorder.offer(ending)
    assertEquals(recorder.records, Samples.oneOfEach.take(2) :+ ending)

  test("records offered after the end of a flight are not in its recording"):
    val recorder = MemoryRecorder(Samples.heading)
    recorder.offer(Samples.reading(1))
    assertEquals(
      recorder.close().value.flatMap(_.toOption).flatMap(_.toOption).map(_.rows("reading")),
      Some(1L)
    )
    recorder.offer(Samples.reading(2))
    recorder.offer(Ending(Samples.at(1), EndingKind.Completed, None))
    assertEquals(recorder.records, Vector(Samples.reading(1)))
