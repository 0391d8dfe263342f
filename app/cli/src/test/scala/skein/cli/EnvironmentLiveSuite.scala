package skein.cli

import java.lang.management.ManagementFactory
import java.nio.charset.StandardCharsets.{ISO_8859_1, US_ASCII, UTF_8}
import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import skein.testing.{Lengthy, TemporaryFolders}

/** Commands as users start them, each in a process of its own, in unusual environments. */
class EnvironmentLiveSuite extends munit.FunSuite, TemporaryFolders, Lengthy:
  private case class Ended(status: Int, out: String, err: String)

  /** @param before shell commands to run first, for example a limit */
  private def skein(in: Path, before: String, jvm: Seq[String], arguments: String*): Ended =
    val agent =
      ManagementFactory.getRuntimeMXBean.getInputArguments.asScala.filter(_.startsWith("-javaagent"))
    val java =
      Seq(
        s"${sys.props("java.home")}/bin/java",
        "-XX:TieredStopAtLevel=1",
        "-XX:+UseSerialGC"
      ) ++ agent ++ jvm
    val words      = java ++ Seq("-cp", sys.props("java.class.path"), "skein.cli.Main") ++ arguments
    val (out, err) = (in.resolve("out.txt"), in.resolve("err.txt"))
    val shell      = ProcessBuilder((Seq("bash", "-c", s"$before exec \"$$@\"", "skein") ++ words)*)
    val process    = shell.directory(in.toFile).redirectOutput(out.toFile).redirectError(err.toFile).start()
    val status     = process.waitFor()
    Ended(status, Files.readString(out, ISO_8859_1), Files.readString(err, ISO_8859_1))

  private def assertOneLine(ended: Ended, expected: String): Unit =
    val lines = ended.err.linesIterator.filterNot(_.startsWith("WARNING")).toVector
    assert(ended.status != 0, clue(ended))
    assert(lines.size == 1 && lines.head.contains(expected), clue(ended))

  folder.test(
    "a flight in a Turkish locale equals one in an English locale, and its output is ASCII where needed"
  ): path =>
    def fly(locale: String, language: String) =
      val words = s"fly --clock virtual --loop stream --link vpn --duration 2s --out $language".split(' ')
      skein(path, s"export LC_ALL=$locale;", Seq(s"-Duser.language=$language"), words*)
    val english = fly("C.UTF-8", "en")
    val turkish = fly("C", "tr")
    assertEquals((english.status, turkish.status), (0, 0), turkish.err)
    def digest(ended: Ended) = ended.err.linesIterator.find(_.contains("SHA-256"))
    assertEquals(digest(turkish), digest(english))
    assert(turkish.out.getBytes(ISO_8859_1).forall(_ > 0), "not ASCII")
    assert(clue(turkish.out).contains("----") && turkish.out.contains(" ... "))

  folder.test("a name that the locale cannot encode is reported in a line"): path =>
    assertOneLine(skein(path, "export LC_ALL=C;", Nil, "report", "flüge.duckdb"), "LC_ALL=C.UTF-8")

  folder.test("with a limit on file sizes, a line states which file could not be written"): path =>
    val ended = skein(
      path,
      "ulimit -f 20;",
      Seq(s"-Djava.io.tmpdir=$path"),
      Seq("fly", "--clock", "virtual", "--loop", "paused", "--duration", "2s", "--out", "flights")*
    )
    assert(ended.status != 0 && !ended.err.contains("\tat "), clue(ended))
    assert(clue(ended.err).contains("too large"))

  test("a low limit of open files is reported before a flight, not as a simulator that does not answer"):
    assertEquals(OpenFiles.enoughFor(7, most = Some(1024)), Right(()))
    assert(clue(OpenFiles.enoughFor(1, most = Some(64))).left.exists(_.contains("ulimit -n 126")))

  test(
    "characters that a terminal cannot show are replaced, even if their bytes arrive separately"
  ):
    val shown = java.io.ByteArrayOutputStream()
    val plain = Terminal.Plain(shown, US_ASCII)
    for byte <- "8.2 … 8.3 ± 1 │ █ ö".getBytes(UTF_8) do plain.write(byte)
    assertEquals(shown.toString(US_ASCII), "8.2 ... 8.3 +/- 1 | # ?")
