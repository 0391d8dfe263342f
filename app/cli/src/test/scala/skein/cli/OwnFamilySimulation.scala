package skein.cli

import java.nio.file.Files
import scala.util.Using
import skein.policy.*
import skein.scenario.Scenarios
import skein.testing.{Lengthy, Optimised, TemporaryFolders}

/** Turns towards the opponent's last known position, less the older it is. */
final case class Doubting(turnRateRadPerS: Double, doubtS: Double) extends HeadingPolicy:
  type Memory = Double
  def start: Double = 0

  def decide(seen: PlanarObservation, memory: Double): (Double, Double) =
    val wanted = math.IEEEremainder(StrictMath.atan2(seen.dyM, seen.dxM) - seen.ownHeadingRad, 2 * math.Pi)
    val most   = turnRateRadPerS * seen.elapsedS * doubtS / (doubtS + seen.opponentAgeS)
    (seen.ownHeadingRad + wanted.max(-most).min(most), memory)

/** A program with a user's own family of policies. */
object Doubters extends SkeinApp(Scenarios.ours.kinds*):
  override def policyFamilies: Seq[PolicyFamily] = Seq(family("doubting"))

  def family(name: String): PolicyFamily =
    PolicyFamily(
      name,
      "turns the less, the older what it knows is",
      Set(Role.Pursuer),
      SearchSpace(Vector(Axis("turnRateRadPerS", 0.2, 3.0, 1.0), Axis("doubtS", 0.05, 2.0, 0.5))),
      numbers => Doubting(numbers(0), numbers(1))
    )

class OwnFamilySimulation extends munit.FunSuite, TemporaryFolders, Lengthy, Optimised:
  private def run(program: SkeinApp, words: String): (Int, String) =
    val ran = Ran.of(program.run(words.split(' ').toSeq))
    (ran.status, ran.said)

  private def done(words: String): String =
    val (status, said) = run(Doubters, words)
    assertEquals(status, 0, said)
    said

  folder.test(
    "a user's own family can be searched with SIMD, flown, replayed and swept by its name"
  ): folder =>
    val found = done(
      "search --family doubting --candidates 16 --episodes 2 --fresh " +
        s"16 --duration 12s --link vpn --out $folder/found"
    )
    assert(found.contains("SIMD"), found)
    val policy = folder.resolve("found/policy.conf")
    assert(Files.readString(policy).contains("family = \"doubting\""))
    done(
      s"fly --clock virtual --policy $policy --loop stream --link vpn --duration 4s --out $folder/flown"
    ): Unit
    val flown = Using.resource(Files.list(folder.resolve("flown")))(
      _.filter(_.toString.endsWith(".duckdb")).toArray.toVector.map(_.toString)
    )
    assertEquals(flown.size, 2)
    for file <- flown do assert(done(s"replay $file").contains("same"), file)
    done(
      s"budget --policy doubting --means 2 --jitters 2 --episodes 10 --duration 12s --out $folder/swept"
    ): Unit

    // A program without the family lists those it has.
    val (status, said) = run(Main, s"fly --clock virtual --policy $policy --out $folder/refused")
    assertEquals(status, 1, said)
    assert(
      said.contains("expected a family of policies (paper-pursuer") && said.contains("got 'doubting'"),
      said
    )

  test("bash completes a user's own family"):
    val search = Doubters.commands.find(_.name == "search").get
    assert(search.options.exists(option => option.flag == "--family" && option.values.contains("doubting")))

  test("two families with one name, and names that options could not distinguish, are refused"):
    def known(names: String*) =
      Scenarios(Scenarios.ours.kinds, names.toVector.map(Doubters.family))
    assertEquals(known("mine", "yours").family("yours").map(_.name), Right("yours"))
    for names <- Seq(Seq("mine", "mine"), Seq("pure-pursuit"), Seq("neural:8x8"), Seq("my own"), Seq("")) do
      intercept[IllegalArgumentException](known(names*)): Unit
