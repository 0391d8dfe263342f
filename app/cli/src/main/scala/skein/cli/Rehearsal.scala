package skein.cli

import java.io.PrintStream
import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import scala.util.Using

/** Runs commands in turn in one JVM, so that an ahead-of-time cache made of this run serves each of them.
  *
  * Its arguments are a file with a command in each line, and a folder that receives the output of those that
  * end with ` > NAME`. Ends with status 1 if one of them failed.
  */
object Rehearsal:
  def main(arguments: Array[String]): Unit =
    val Array(list, answers) = arguments.map(Path.of(_)): @unchecked
    // A cache needs each class once; the virtual flights before the live ones have used those of a warm-up.
    FlyCommand.skipWarmUp()
    val failed = Files.readAllLines(list).asScala.toSeq.map(_.split(" > ")).filter: line =>
      val words   = line.head.split(' ').toSeq
      val succeed = line.lift(1) match
        case None       => Main.run(words) == 0
        case Some(name) =>
          Using.resource(PrintStream(answers.resolve(name).toFile)): file =>
            Console.withOut(file)(Main.run(words)) == 0
      !succeed
    failed.foreach(line => Console.err.println(s"skein: this failed: ${line.head}"))
    sys.exit(failed.size.min(1))
