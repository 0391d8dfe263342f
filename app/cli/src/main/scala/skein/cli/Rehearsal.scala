package skein.cli

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*

/** Runs commands in turn in one JVM, so that an ahead-of-time cache made of this run serves each of them.
  *
  * Its argument is a file with a command in each line. Ends with status 1 if one of them failed.
  */
object Rehearsal:
  def main(arguments: Array[String]): Unit =
    val commands = Files.readAllLines(Path.of(arguments.head)).asScala.toSeq.filter(_.nonEmpty)
    // A cache needs each class once; the virtual flights before the live ones have used those of a warm-up.
    FlyCommand.skipWarmUp()
    val failed = commands.filter(command => Main.run(command.split(' ').toSeq) != 0)
    failed.foreach(command => Console.err.println(s"skein: this failed: $command"))
    sys.exit(failed.size.min(1))
