package skein.settings

import java.nio.file.{Files, Path}
import skein.policy.{PaperPursuer, PolicyFamily, Role}
import skein.scenario.{PaperDuel, Scenarios}
import skein.testing.TemporaryFolders

class PolicyFileSuite extends munit.FunSuite, TemporaryFolders:
  private given Scenarios = Scenarios.ours

  private def read(folder: Path, text: String): Either[String, PolicyFile] =
    PolicyFile.read(Files.writeString(folder.resolve("policy.conf"), text).toString)

  folder.test("a written policy is read back, with any remarks below it"): folder =>
    for family <- PolicyFamily.all; role <- family.roles if role == Role.Pursuer || role == Role.Evader do
      val policy =
        PolicyFile(role, family, family.space.axes.map(axis => axis.least + 0.123456789012345 * axis.width))
      val again = read(folder, policy.hocon("objective { mean = 3 }\n"))
      assertEquals(again, Right(policy))
      assertEquals(PolicyFile.parse(role, policy.text), Right(policy))

  folder.test("a file's policy is the policy of its family with the file's parameters"): folder =>
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
    folder.test(s"$what is refused with its position and what was expected"): folder =>
      val mistake = read(folder, text).left.getOrElse("accepted")
      for part <- expected do assert(mistake.contains(part), mistake)

  test("a policy's text has each of its parameters once, in order"):
    def parsed(text: String) = PolicyFile.parse(Role.Pursuer, text).map(_.parameters)
    assertEquals(parsed("paper-pursuer turnRateRadPerS=1.5"), Right(Vector(1.5)))
    for wrong <- Seq("", " speed=1.5", " turnRateRadPerS=fast", " turnRateRadPerS=1 turnRateRadPerS=1") do
      assertEquals(
        parsed(s"paper-pursuer$wrong"),
        Left(s"expected turnRateRadPerS=NUMBER after paper-pursuer, got 'paper-pursuer$wrong'")
      )

  test("a policy is used by exactly the agents of its role"):
    val fleet  = PaperDuel().fleet
    val policy = PolicyFile(Role.Pursuer, PolicyFamily.paperPursuer, Vector(1.5))
    assertEquals(
      policy.flownIn(fleet).agents.map(agent => (agent.name, agent.policy)),
      fleet.agents.map: agent =>
        (agent.name, if agent.role == Role.Pursuer then PaperPursuer(1.5) else agent.policy)
    )

  test("the role may be omitted for a family of one role, but not for a family of both"):
    val one  = PolicyFamily.paperPursuer
    val both = PolicyFamily("either", "", Set(Role.Pursuer, Role.Evader), one.space, one.policy)
    assertEquals(PolicyFile.roleOf(one, None), Right(Role.Pursuer))
    assertEquals(PolicyFile.roleOf(both, Some("evader")), Right(Role.Evader))
    assertEquals(
      PolicyFile.roleOf(both, None),
      Left("family either is for pursuer and evader: expected one of them, got none")
    )

  test("a missing file is reported with its path"):
    val mistake = PolicyFile.read("no/such/policy.conf").left.getOrElse("accepted")
    assert(mistake.contains("no/such/policy.conf"), mistake)
