package skein.cli

import java.nio.file.{Files, Path}
import skein.policy.PolicyFamily
import skein.scenario.Scenarios
import skein.settings.PolicyFile
import skein.testing.TemporaryFolders

class PolicyCommandSuite extends munit.FunSuite, TemporaryFolders:
  private given Scenarios = Scenarios.ours

  private def run(words: String*): (Int, String) =
    val ran = Ran.of(Main.run("policy" +: words))
    (ran.status, ran.said)

  private def written(folder: Path, name: String): String =
    val family = PolicyFamily.parse(name).fold(fail(_), identity)
    val values = Vector.tabulate(family.space.dimension)(i => (i % 7) / 8.0)
    Files
      .writeString(folder.resolve("policy.conf"), PolicyFile(family.roles.head, family, values).hocon(""))
      .toString

  test("a network converted to ONNX and back is identical to the bit"):
    val folder         = temporaryFolder()
    val file           = written(folder, "learned:4x3")
    val onnx           = folder.resolve("policy.onnx").toString
    val conf           = folder.resolve("again.conf").toString
    val (status, said) = run(file, "--onnx", onnx)
    assertEquals(status, 0, said)
    assert(said.contains("learned:4x3"), said)
    val (again, told) = run(onnx, "--conf", conf)
    assertEquals(again, 0, told)
    assertEquals(PolicyFile.read(conf).map(_.text), PolicyFile.read(file).map(_.text))
    assertEquals(PolicyFile.read(conf).map(_.role), PolicyFile.read(file).map(_.role))

  test("a policy that is not a network, a missing file, and an unusable folder are reported"):
    val folder = temporaryFolder()
    for
      (words, expected) <- Seq(
        Seq(written(folder, "paper-pursuer"), "--onnx", folder.resolve("x.onnx").toString) -> "only networks",
        Seq("nowhere.onnx") -> "there is no such file",
        Seq.empty           -> "expected one policy file, got 0"
      )
    do
      val (status, said) = run(words*)
      assertEquals(status, 1, said)
      assert(said.contains(expected), said)
