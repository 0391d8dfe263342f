package skein.python

import java.io.{File, IOException}
import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import scala.sys.process.{Process, ProcessLogger}
import scala.util.Using
import skein.testing.{Lengthy, TemporaryFolders}

/** The wheel, installed as by a user into a fresh environment, in which it trains. Skipped without Python, or
  * if its packages cannot be fetched. The package's own tests take longer, and run if Python has their
  * dependencies.
  */
class PythonPackageLiveSuite extends munit.FunSuite, TemporaryFolders, Lengthy:
  private val root = Iterator
    .iterate(Path.of("").toAbsolutePath)(_.getParent)
    .find(at => Files.exists(at.resolve("sbtw")))
    .get
  private val target = root.resolve("app/python/target")

  private def wheel: Either[String, Path] =
    val why = target.resolve("no-wheel.txt")
    if Files.exists(why) then Left(Files.readString(why))
    else
      Option
        .when(Files.exists(target.resolve("dist"))):
          Using.resource(
            Files.list(target.resolve("dist"))
          )(_.iterator.asScala.find(_.toString.endsWith(".whl")))
        .flatten
        .toRight("./sbtw python/wheel was not run before")

  private lazy val home = temporaryFolder().resolve("environment")

  private def python(words: String*): Either[String, String] =
    ran(home.resolve("bin/python").toString +: words*)

  test("one line installs the wheel into a fresh environment"):
    assume(wheel.isRight, wheel.left.getOrElse(""))
    // With a pip of its own it would take twice the time.
    val made = ran("python3", "-m", "venv", "--without-pip", home.toString)
    assume(made.isRight, made.left.getOrElse(""))
    val pip =
      "python3 -m pip --python PLACE install --quiet --disable-pip-version-check --no-compile".split(' ')
    val installed = ran(
      pip.updated(
        pip.indexOf("PLACE"),
        home.toString
      ).toSeq :+ s"skein-uav[learn] @ ${wheel.toOption.get.toUri}"*
    )
    assert(installed.isRight, installed.left.getOrElse(""))

  test("in the fresh environment, the ten lines of the example train a pursuer"):
    assume(Files.exists(home), "nothing was installed")
    val trained   = python(root.resolve("examples/learn-in-python/learn.py").toString)
    val distances = """mean distance ([0-9.]+) m""".r
      .findAllMatchIn(trained.fold(fail(_), identity))
      .map(_.group(1).toDouble)
      .toVector
    assert(distances.last < distances.head - 2, distances.mkString(", "))

  test("the package passes its own tests, if python3 has the required packages"):
    assumeTestable()
    val passed = ran("python3", "-m", "pytest", "-q", ".", "--ignore=tests/test_notebooks.py")
    assert(passed.isRight, passed.left.getOrElse(""))

  for name <- Seq("measure-my-loop", "write-and-search", "train-under-delay", "delay-anywhere") do
    test(s"the notebook $name runs from top to bottom, if python3 has the required packages"):
      assumeTestable()
      val passed = ran("python3", "-m", "pytest", "-q", "-rs", "-k", name, "tests/test_notebooks.py")
      assert(passed.isRight, passed.left.getOrElse(""))
      val skipped = passed.fold(fail(_), identity).linesIterator.find(_.startsWith("SKIPPED"))
      assume(skipped.isEmpty, skipped.getOrElse(""))

  private def assumeTestable(): Unit =
    val needed = ran("python3", "-c", "import duckdb, gymnasium, jpype, pandas, pettingzoo, pytest")
    assume(needed.isRight, needed.left.getOrElse("").linesIterator.toSeq.lastOption.getOrElse(""))
    assume(
      Files.exists(root.resolve("app/cli/target/universal/stage/bin/skein")),
      "./sbtw cli/stage was not run before"
    )

  private def ran(command: String*): Either[String, String] =
    val output = StringBuilder()
    try
      val status = Process(command, Some(root.resolve("app/python").toFile): Option[File])
        .!(ProcessLogger(line => output.append(line).append('\n'): Unit))
      Either.cond(
        status == 0,
        output.toString,
        s"${command.mkString(" ")}: ${output.toString.takeRight(4000)}"
      )
    catch case missing: IOException => Left(missing.getMessage)
