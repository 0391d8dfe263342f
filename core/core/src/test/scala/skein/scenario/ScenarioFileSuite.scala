package skein.scenario

import skein.policy.{Action, GraphPolicy, Observation, PolicyFormula, Seen, Yaw}
import skein.signal.{Kinematics, SplitMix64}
import skein.units.*

/** A scenario file defines vehicles, policies and measures; every mistake in it gives a one-line message with
  * its place.
  */
class ScenarioFileSuite extends munit.FunSuite:
  import ScenarioFileSuite.*

  private def read(text: String) = ScenarioText.read(text).fold(why => fail(why), identity)

  private def stated(set: (String, String)*): Scenario =
    read(Patrol).read(set.toMap).fold(why => fail(why.mkString), identity)

  private def seen(random: SplitMix64, self: Int): Observation =
    def within(most: Double) = most * (2 * random.nextDouble() - 1)
    val vehicles             = Vector.fill(2)(Seen(
      Kinematics(
        Vector3(within(30), within(30), -5 + within(1)),
        Vector3(within(8), within(8), within(1)),
        Quaternion.Identity,
        Vector3.Zero
      ),
      Span.ofMillis(random.nextDouble() * 100),
      isPredicted = false
    ))
    Observation(
      self,
      vehicles,
      1 - self,
      Vector.fill(2)(Radians(within(3))),
      Span.ofMillis(100),
      1,
      MetresPerSecond(5),
      Metres(-5)
    )

  test("vehicles, settings, limits, measures and duration come from the file"):
    val patrol = stated("ring" -> "7")
    assertEquals(patrol.name, "patrol")
    assertEquals(patrol.settings, Vector("ring" -> "7.0", "pace" -> "5.0"))
    assertEquals(patrol.agents.map(_.name), Vector("Runner", "Scout 1"))
    assertEquals(patrol.agents(1).startPositionNed, Vector3(7, 0, -5))
    assertEquals(patrol.agents(1).speed, MetresPerSecond(5))
    assertEquals(patrol.duration, Span.ofSeconds(30))
    assertEquals(patrol.limits.map(_.text), Vector("separation of at least 1 m"))
    assertEquals(patrol.measures.map(_.title), Vector("off ring m", "nearest m", "close by s"))
    assert(patrol.measures(0).reduced.isDefined, "a search can optimise it")
    assertEquals(patrol.document.map(_._1), Some(ScenarioFile.Recorded))

  test("a policy decides by its graph, with memory, and performs the first action whose condition holds"):
    val policy         = stated().agents(1).policy.asInstanceOf[GraphPolicy]
    val random         = SplitMix64(3)
    val now            = seen(random, 1)
    val way            = now.vehicles(0).kinematics.positionNed - now.own.kinematics.positionNed
    val (action, next) = policy.choose(now, policy.start)
    val heading        = StrictMath.atan2(way.y, way.x)
    val isNear         = StrictMath.hypot(way.x, way.y) < 5
    if !isNear then
      assertEquals(action, Action.Along(Radians(heading), MetresPerSecond(5), Metres(-5), Yaw.Forward))
    assertEquals(next.toVector, Vector(heading))
    val beside = now.copy(vehicles = Vector(now.own, now.own))
    assertEquals(policy.choose(beside, next)._1, Action.Hover)

  test("a file that may end its flight ends it, and a quantity of velocities is not optimised"):
    val ending               = read(Patrol + "over 12\n").standard
    def known(north: Double) =
      val still = Kinematics(Vector3(0, 0, 0), Vector3.Zero, Quaternion.Identity, Vector3.Zero)
      val away  = still.copy(positionNed = Vector3(north, 0, 0))
      Known(Span.ofSeconds(1), Vector(still, away).map(Seen(_, Span.Zero, isPredicted = false)))
    assert(ending.isOver(known(4)) && !ending.isOver(known(6)))
    val fast = read(Patrol + "20 north-mps 0\nseries speed m/s 20\nmeasure fastest most\n").standard
    assertEquals(fast.measures.last.reduced, None)

  test("the formula of a graph policy is its graph, and no bytecode is read"):
    val level   = read(Patrol.replace("does when 12 hover\n", ""))
    val team    = level.standard.fleet
    val policy  = team.agents(1).policy.asInstanceOf[GraphPolicy]
    val formula =
      PolicyFormula.of(policy, 1, team.assignment, isPredicted = false).fold(throw _, identity)
    val other = level.read(Map("pace" -> "2.5")).fold(why => fail(why.mkString), identity).agents(1).policy
    assert(formula.fits(other, team.assignment) && !formula.fits(team.agents(0).policy, team.assignment))
    assertEquals(formula.parametersOf(other).toVector, Vector(4.0, 2.5))
    assertEquals(formula.startOf(other).toVector, Vector(0.0))
    assertEquals(formula.leaves(other, Metres(-5)), None)
    assertEquals(formula.turns, true)
    def formulaOf(text: String) =
      PolicyFormula.of(read(text).standard.agents(1).policy, 1, team.assignment, isPredicted = false)
    assert(formulaOf(Patrol).exists(_.vertical.nonEmpty))
    assert(formulaOf(Patrol.replace(
      "does when 12 hover",
      "does when 12 land"
    )).left.exists(_.getMessage.contains("it decides for Action.Land")))

  for (name, change, expected) <- Mistakes do
    test(s"a mistake in a file is reported in one line: $name"):
      val came = ScenarioText.read(change(Patrol)).left.toOption
      assertEquals(came, Some(expected))

  test("a file with too deep a chain of nodes, or with too many nodes in all, is refused"):
    def file(nodes: Iterator[String], vehicles: Int, does: Int) =
      val team = (0 until vehicles).map(one => s"vehicle V$one v 0 0 0 0 0\ndoes along $does $does $does\n")
      s"skein-scenario 1\nname large\n0 const 0\n1 north 0\n${nodes.mkString("\n")}\n${team.mkString}"
    def chain(count: Int) = Iterator.range(2, count).map(node => s"$node add 1 ${node - 1}")
    assertEquals(
      ScenarioText.read(file(chain(9_000), 1, 1)).left.toOption,
      Some("line 5005: expected at most 5000 operations upon one another, got more")
    )
    assertEquals(
      ScenarioText.read(file(chain(4_000), 100, 3_999)).left.toOption.map(_.replaceAll(
        "line [0-9]+",
        "line"
      )),
      Some("line: expected at most 200000 nodes in what all vehicles do, got more")
    )

  test("a mutated file is read, or refused with one line (seed 5)"):
    val whole =
      ScenarioMutants.check(Patrol, seed = 5, count = 20_000)((text, why) => fail(why + "\n" + text))
    assert(whole > 200 && whole < 19_000, s"$whole of 20000 could be read")

object ScenarioFileSuite:
  /** A scenario with a runner, and a scout that flies towards it and waits beside it. */
  val Patrol: String =
    """skein-scenario 1
      |# two vehicles
      |name patrol
      |note "A scout \"patrols\"."
      |setting ring 4.0 "start of the scout, m"
      |setting pace 5.0 "its speed, m/s"
      |0 const 30.0
      |1 const 0.0
      |2 setting ring
      |3 setting pace
      |4 north 0
      |5 north 1
      |6 sub 4 5
      |7 east 0
      |8 east 1
      |9 sub 7 8
      |10 hypot 6 9
      |11 const 5.0
      |12 le 10 11
      |13 atan2 9 6
      |14 start-down
      |15 const -5.0
      |16 sub 10 2
      |17 cruise
      |18 const 1.0
      |19 where 12 18 1
      |duration 0
      |vehicle Runner Evader 18 1 1 15 1
      |does along 1 17 14
      |vehicle "Scout 1" Pursuer 3 2 1 15 1
      |does when 12 hover
      |does along 13 3 14 yaw forward
      |remembers 1 13
      |limit separation 18
      |series "off the ring" m 16 bound ring 2
      |measure "off ring" rms last 18
      |measure nearest least
      |series close "" 19
      |measure "close by" time-positive
      |""".stripMargin

  /** Changes of the file, each with the resulting message. */
  private val Mistakes: Seq[(String, String => String, String)] =
    def line(of: String, by: String)(text: String) = text.replace(of + "\n", by + "\n")
    Seq(
      (
        "another version",
        line("skein-scenario 1", "skein-scenario 2"),
        "line 1: expected version 1, got '2'; a newer Skein may read it"
      ),
      ("another text", _ => "hello", "line 1: expected 'skein-scenario 1', got another first line"),
      (
        "the name of a flight's setting",
        line("name patrol", "name seed"),
        "line 3: expected a scenario's name that is no setting of flights, got 'seed'"
      ),
      ("no text", _ => "", "line 1: expected 'skein-scenario 1', got another first line"),
      ("a node too many", line("6 sub 4 5", "7 sub 4 5"), "line 13: expected node 6, the next one, got '7'"),
      (
        "a later node",
        line("6 sub 4 5", "6 sub 4 6"),
        "line 13: expected a number's node of an earlier line, from 0 to 5, got '6'"
      ),
      (
        "a condition in the place of a number",
        line("13 atan2 9 6", "13 atan2 9 12"),
        "line 20: expected a number's node, got node 12, which is a condition"
      ),
      (
        "an operation that there is not",
        line("10 hypot 6 9", "10 system 6 9"),
        "line 17: expected an operation, such as add, got 'system'"
      ),
      (
        "a word too many",
        line("10 hypot 6 9", "10 hypot 6 9 1"),
        "line 17: expected the line's end, got '1'"
      ),
      ("no number", line("0 const 30.0", "0 const NaN"), "line 7: expected a constant, a number, got 'NaN'"),
      (
        "a setting that there is not",
        line("2 setting ring", "2 setting rings"),
        "line 9: expected a setting of an earlier line, got 'rings'"
      ),
      (
        "a vehicle that there is not",
        line("4 north 0", "4 north 2"),
        "line 30: expected vehicles from 0 to 1, got a node of vehicle 2"
      ),
      (
        "a start that depends on what is observed",
        line("vehicle Runner Evader 18 1 1 15 1", "vehicle Runner Evader 18 1 6 15 1"),
        "line 28: expected a number of settings alone, got node 6, which depends on what is observed"
      ),
      (
        "no action without a condition",
        line("does along 13 3 14 yaw forward", "does when 12 land"),
        "line 30: expected a last action 'does' without a condition for this vehicle, got none"
      ),
      (
        "an action that is never performed",
        line("remembers 1 13", "does hover"),
        "line 33: expected no action after the one without a condition, got one that is never performed"
      ),
      (
        "a memory that there is not",
        line("17 cruise", "17 memory 0"),
        "line 28: expected a memory of 1 numbers, lines 'remembers', got 0"
      ),
      (
        "a reduction that there is not",
        line("measure nearest least", "measure nearest median"),
        "line 37: expected a reduction, one of mean, rms, sd, least, most, least-at, most-at, time-positive, " +
          "first-positive, stays-positive, entries, got 'median'"
      ),
      (
        "two vehicles of one name",
        _.replace("\"Scout 1\"", "Runner"),
        "by its defaults: agents: expected a name of its own for each, got 'Runner' twice"
      ),
      (
        "a flight of no time",
        line("0 const 30.0", "0 const -1"),
        "by its defaults: duration: expected more than 0 s and at most a day, got -1.0"
      ),
      (
        "no vehicles",
        _.linesIterator.takeWhile(!_.startsWith("vehicle")).mkString("\n"),
        "expected a vehicle, got none"
      ),
      (
        "a text without an end",
        line("measure nearest least", "measure \"nearest least"),
        "line 37: expected a quotation mark at the end of a text, got the line's end"
      ),
      (
        "too long a file",
        _ + "#".repeat(5_000_000),
        "expected at most 4194304 letters, got 5000722: too many vehicles, or too long policies"
      )
    )
