package skein.bench

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import skein.plot.{Colour, Png}
import skein.training.{LearnScore, LearningCurve}

/** Draws learning curves of several learners in one picture, from tables that `./skein learn` wrote. Run:
  * `./sbtw "bench/runMain skein.bench.LearningCurves OUT.png 'TITLE' 'NAME=FILE.csv' …"`; `NAME=NUMBER` draws
  * a level.
  */
object LearningCurves:
  private val colours = Vector(0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0xe69f00, 0x56b4e9).map(Colour(_))

  def main(args: Array[String]): Unit =
    val (out, title)     = (Path.of(args(0)), args(1))
    val (levels, curves) = args.toVector.drop(2).map(_.split("=", 2)).partitionMap:
      case Array(name, value) => value.toDoubleOption.map(name -> _).toLeft(name -> read(Path.of(value)))
      case _                  => sys.error("expected NAME=FILE.csv or NAME=NUMBER")
    val drawn = curves.zip(colours).map((curve, colour) => (curve._1, colour, curve._2))
    val lines = levels.zip(Vector(LearningCurve.paper, Colour(0x888888))).map((level, colour) =>
      (level._1, colour, level._2)
    )
    for (name, scores) <- curves do
      println(f"$name: last ${scores.last.mean}%.2f m, best ${scores.map(_.mean).min}%.2f m")
    val picture = LearningCurve(title, "distance over the last 10 s, m", drawn, lines)
    println(s"wrote ${Files.write(out, Png.bytes(picture, 2).fold(sys.error, identity))}")

  private def read(file: Path): Vector[LearnScore] =
    Files.readAllLines(file).asScala.toVector.tail.map: line =>
      val Array(steps, mean, sd) = line.split(','): @unchecked
      LearnScore(steps.toLong, mean.toDouble, sd.toDouble)
