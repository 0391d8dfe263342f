package skein.cli

import java.io.ByteArrayOutputStream
import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.Files
import scala.concurrent.duration.*

class SearchCommandSuite extends munit.FunSuite:
  override val munitTimeout: Duration = 2.minutes

  test("with --json a search prints its result as data, and all else to the error output"):
    val folder     = Files.createTempDirectory("search")
    val (out, err) = (ByteArrayOutputStream(), ByteArrayOutputStream())
    val words      =
      "search --family lead-pursuit --candidates 8 --episodes 1 --fresh 2 --duration 12s --json --out".split(
        ' '
      ).toSeq
    val status =
      Console.withOut(out)(Console.withErr(err)(Main.run(words :+ folder.resolve("found").toString)))
    assertEquals(status, 0, err.toString(UTF_8))
    val table = ujson.read(out.toString(UTF_8))("tables")(0)
    assertEquals(table("columns")(0).str, "policy")
    val Seq(found, paper) = table("rows").arr.toSeq: @unchecked
    assertEquals((found(0).str, paper(0).str), ("lead-pursuit", "paper-pursuer"))
    assertEquals((found(4).num, paper(4).num), (2.0, 2.0))
    assert(found(2).num > 0 && found(3).num > 0, found.toString)
    assert(err.toString(UTF_8).contains("policy.conf"))
