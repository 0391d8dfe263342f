package skein

import java.nio.file.{Files, Path}

/** Holds the README to code that compiles. */
class ReadmeSuite extends munit.FunSuite:

  test("the README's example is the one that the tests compile"):
    val root = Iterator.iterate(Path.of("").toAbsolutePath)(_.getParent).find(p =>
      Files.exists(p.resolve("README.md"))
    ).get
    val source  = Files.readString(root.resolve("flight/src/test/scala/skein/ReadmeExample.scala"))
    val example = source.linesIterator.dropWhile(
      !_.contains("README begins")
    ).drop(1).takeWhile(!_.contains("README ends"))
    val shown = example.map(_.stripPrefix("    ")).mkString("\n")
    assert(Files.readString(root.resolve("README.md")).contains(shown), s"README.md lacks:\n$shown")
