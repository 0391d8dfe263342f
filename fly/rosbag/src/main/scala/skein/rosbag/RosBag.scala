package skein.rosbag

import java.nio.file.{Files, Path}
import scala.collection.immutable.VectorMap
import scala.collection.mutable
import skein.mcap.file.McapFile
import skein.mcap.{Bytes, McapWriter, WriterOptions}
import skein.record.{FileReason, RecordingReader}
import skein.ros.message.{MessageDefinition, MessageType}
import skein.units.{Instant, Span}

/** Writes bags of ROS 2: a folder with `metadata.yaml` and an MCAP file of the profile `ros2`, in which every
  * type has its definition, so that readers need no installed packages. `ros2 bag play` plays them.
  */
object RosBag:

  /** Writes a recording as a bag, with the topics of [[BagMessages]]. Blocks. Keeps the whole recording in
    * memory.
    *
    * @param folder must be empty, or not exist yet in an existing folder
    * @return the number of messages of each topic
    */
  def write(recording: Path, folder: Path): Either[String, VectorMap[String, Long]] =
    for
      rows    <- RecordingReader.records(recording).left.map(_.message)
      written <- FileReason.attempt(why => s"cannot write the bag $folder: $why"):
        write(BagMessages(rows.map(_._2)).all, folder)
    yield written

  private def write(messages: Iterator[BagMessage], folder: Path): VectorMap[String, Long] =
    Files.createDirectories(folder)
    val file   = s"${folder.toAbsolutePath.normalize.getFileName}_0.mcap"
    val topics = McapFile.write(folder.resolve(file), WriterOptions("ros2", "skein")): mcap =>
      val out = Topics(mcap)
      messages.foreach(out.put)
      out
    Files.writeString(folder.resolve("metadata.yaml"), metadata(file, topics)): Unit
    topics.counts

  private final class Topics(mcap: McapWriter):
    private val schemas  = mutable.Map.empty[String, Int]
    private val channels = mutable.LinkedHashMap.empty[String, (id: Int, kind: MessageType[?])]
    private val sizes    = mutable.Map.empty[String, Long].withDefaultValue(0)
    var first            = Option.empty[Instant]
    var last             = Instant.Epoch

    def put(message: BagMessage): Unit =
      val channel = channels.getOrElseUpdate(message.topic, (open(message), message.kind))
      val at      = message.at.toNanos.max(0)
      mcap.message(channel.id, sizes(message.topic).toInt, at, at, Bytes.of(message.bytes))
      sizes(message.topic) += 1
      if first.forall(message.at < _) then first = Some(message.at)
      last = last.max(message.at)

    private def open(message: BagMessage): Int =
      val name   = message.kind.toString
      val schema = schemas.getOrElseUpdate(
        name,
        mcap.schema(name, "ros2msg", Bytes.utf8(MessageDefinition.whole(message.kind)))
      )
      mcap.channel(message.topic, "cdr", schema, VectorMap("offered_qos_profiles" -> ""))

    def kinds: Vector[(String, MessageType[?])] = channels.toVector.map((topic, known) => (topic, known.kind))
    def counts: VectorMap[String, Long]         =
      channels.keysIterator.map(topic => topic -> sizes(topic)).to(VectorMap)

  /** Format 5 of rosbag2, which Humble and everything later reads. */
  private def metadata(file: String, topics: Topics): String =
    val from   = topics.first.getOrElse(Instant.Epoch)
    val lasts  = topics.first.fold(Span.Zero)(topics.last.since)
    val counts = topics.counts
    val listed = topics.kinds.map: (topic, kind) =>
      s"""    - topic_metadata:
         |        name: $topic
         |        type: $kind
         |        serialization_format: cdr
         |        offered_qos_profiles: ""
         |      message_count: ${counts(topic)}
         |""".stripMargin
    s"""rosbag2_bagfile_information:
       |  version: 5
       |  storage_identifier: mcap
       |  duration:
       |    nanoseconds: ${lasts.toNanos}
       |  starting_time:
       |    nanoseconds_since_epoch: ${from.toNanos}
       |  message_count: ${counts.values.sum}
       |  topics_with_message_count:${if listed.isEmpty then " []" else ""}
       |${listed.mkString}  compression_format: ""
       |  compression_mode: ""
       |  relative_file_paths:
       |    - "$file"
       |  files:
       |    - path: "$file"
       |      starting_time:
       |        nanoseconds_since_epoch: ${from.toNanos}
       |      duration:
       |        nanoseconds: ${lasts.toNanos}
       |      message_count: ${counts.values.sum}
       |""".stripMargin
