package skein.vtime

import java.nio.file.{Files, Path}

class ReadmeSuite extends munit.FunSuite:

  test("the README shows the example that is compiled and run here"):
    val example = Files.readString(Path.of("src/test/scala/skein/vtime/example/SilenceSuite.scala"))
    assert(Files.readString(Path.of("README.md")).contains(s"```scala\n$example```\n"))
