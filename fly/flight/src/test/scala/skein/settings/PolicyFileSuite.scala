package skein.settings

import java.nio.file.{Files, Path}
import skein.policy.{PaperPursuer, PolicyFamily, Role}
import skein.scenario.Scenarios
import skein.testing.TemporaryFolders

class PolicyFileSuite extends munit.FunSuite, TemporaryFolders:
  private given Scenarios = Scenarios.ours

  private def read(folder: Path, text: String): Either[String, PolicyFile] =
    PolicyFile.read(Files.writeString(folder.resolve("policy.conf"), text).toString)

  folder.test("a policy that was written is read back, with any remarks below"): folder =>
    for family <- PolicyFamily.all; role <- family.roles if role == Role.Pursuer || role == Role.Evader do
      val policy =
        PolicyFile(role, family, family.space.axes.map(axis => axis.least + 0.123456789012345 * axis.width))
      val again = read(folder, policy.hocon("objective { mean = 3 }\n"))
      assertEquals(again, Right(policy))
      assertEquals(PolicyFile.parse(role, policy.text), Right(policy))

  folder.test("its policy is the family's with these parameters"): folder =>
    val policy = read(folder, "family = paper-pursuer\nparameters.turnRateRadPerS = 1.5").map(_.policy)
    assertEquals(policy, Right(PaperPursuer(1.5)))

  for
    (what, text, expected) <- Seq(
      ("an unknown family", "family = nosuch", Seq("line 1", "paper-pursuer", "'nosuch'")),
      ("no family", "parameters {}", Seq("'family'", "missing")),
      ("no parameters", "family = paper-pursuer", Seq("'parameters'", "missing")),
      (
        "a parameter too many",
        "family = paper-pursuer\nparameters {\n turnRateRadPerS = 1\n speed = 2\n}",
        Seq("line 4", "turnRateRadPerS", "'speed'")
      ),
      (
        "a parameter too few",
        "family = paper-pursuer\nparameters {}",
        Seq("turnRateRadPerS", "missing")
      ),
      (
        "a parameter that is no number",
        "family = paper-pursuer\nparameters {\n turnRateRadPerS = fast\n}",
        Seq("line 3", "a finite number", "'fast'")
      ),
      (
        "a role that the family is not for",
        "family = paper-pursuer\nrole = evader\nparameters { turnRateRadPerS = 1 }",
        Seq("pursuer", "'evader'")
      ),
      ("no HOCON", "family = {", Seq("policy.conf"))
    )
  do
    folder.test(s"$what is refused with place and expectation"): folder =>
      val mistake = read(folder, text).left.getOrElse("accepted")
      for part <- expected do assert(mistake.contains(part), mistake)

  test("a missing file is named"):
    val mistake = PolicyFile.read("no/such/policy.conf").left.getOrElse("accepted")
    assert(mistake.contains("no/such/policy.conf"), mistake)
