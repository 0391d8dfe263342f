package skein.rosbag

import java.io.IOException
import java.nio.file.{Files, Path}
import scala.collection.mutable
import scala.jdk.StreamConverters.StreamHasToScala
import scala.util.Using
import skein.mcap.file.McapFile
import skein.observe.ObservedTopics
import skein.record.FileReason
import skein.units.{Expect, Instant}

/** Measures the loop in a bag of ROS 2 with MCAP files and any message types.
  *
  * @param readings topics with vehicles' readings; if empty, those of poses whose name does not suggest
  *   commands
  * @param commands topics of commands; if empty, those of twists and poses whose name suggests commands
  */
final class BagLoop(readings: Set[String], commands: Set[String]):
  import BagLoop.*

  /** Reads a bag: its folder, or an MCAP file.
    *
    * @return Left says in a line why it is not a bag, or which topic is missing
    */
  def observed(bag: Path): Either[String, ObservedTopics] =
    val loop = TopicLoop(readings, commands)
    for
      files <- mcapFiles(bag)
      seen  <- Expect.each(files)(add(_, loop)).map(_.flatten.toSet)
      _     <- loop.missing(seen).headOption.toLeft(()).left.map: missing =>
        s"expected the topic $missing in $bag, it has ${
            if seen.isEmpty then "none" else seen.toVector.sorted.mkString(", ")
          }"
    yield loop.observed

object BagLoop:
  /** Adds the messages of a file.
    *
    * @return the names of its topics
    */
  private def add(file: Path, loop: TopicLoop): Either[String, Iterable[String]] =
    val topics = mutable.Map.empty[Int, (name: String, add: Option[TopicLoop.Topic])]
    FileReason
      .attempt(why => s"cannot read $file: $why"):
        McapFile.read(file): messages =>
          val failed = messages
            .flatMap:
              case Left(error)    => Some(s"$file: ${error.message}")
              case Right(message) =>
                val name  = message.channel.topic
                def topic = loop.topic(
                  name,
                  message.schema.fold("")(_.name),
                  message.schema.fold("")(_.data.utf8)
                )
                val known = topics.getOrElseUpdate(message.channel.id, (name = name, add = topic))
                known.add.foreach(_(message.message.data, Instant.ofNanos(message.message.logTime)))
                None
            .nextOption()
          failed.toLeft(topics.values.map(_.name))
      .flatten

  /** Time of a file's first message; by their names, the eleventh file of a bag would come before the third.
    */
  private def begin(file: Path): Long =
    try
      McapFile.read(file)(_.collectFirst { case Right(one) => one.message.logTime }.getOrElse(Long.MaxValue))
    catch case _: IOException => Long.MaxValue // it is reported when its messages are read

  private def mcapFiles(bag: Path): Either[String, Vector[Path]] =
    if Files.isRegularFile(bag) then Right(Vector(bag))
    else if !Files.isDirectory(bag) then Left(s"$bag: expected a bag's folder or an MCAP file, there is none")
    else
      val files = Using.resource(Files.list(bag))(_.toScala(Vector)).sorted
      val mcap  = files.filter(_.toString.endsWith(".mcap"))
      Either.cond(
        mcap.nonEmpty,
        if mcap.sizeIs > 1 then mcap.sortBy(begin) else mcap,
        if files.exists(_.toString.endsWith(".db3")) then
          s"$bag: expected MCAP, got SQLite; `ros2 bag convert` makes the one from the other"
        else s"$bag: expected a bag's folder, it has no MCAP file"
      )
