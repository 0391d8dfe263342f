package skein.cli

import java.io.ByteArrayOutputStream
import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*

/** Runs commands in turn in one JVM, so that an ahead-of-time cache made of this run serves each of them.
  *
  * Its arguments are a file with a command in each line, and a folder that receives the output of those that
  * end with ` > NAME`, unless they failed. Ends with status 1 if one of them failed.
  */
object Rehearsal:
  def main(arguments: Array[String]): Unit =
    val Array(list, answers) = arguments.map(Path.of(_)): @unchecked
    // A cache needs each class once; the virtual flights before the live ones have used those of a warm-up.
    FlyCommand.skipWarmUp()
    def succeeds(command: String): Boolean = Main.run(command.split(' ').toSeq) == 0
    val failed                             = Files.readAllLines(list).asScala.toSeq.filterNot:
      case s"$command > $name" =>
        val printed = ByteArrayOutputStream()
        val isDone  = Console.withOut(printed)(succeeds(command))
        if isDone then Files.write(answers.resolve(name), printed.toByteArray): Unit
        isDone
      case command => succeeds(command)
    failed.foreach(line => Console.err.println(s"skein: this failed: $line"))
    sys.exit(failed.size.min(1))
