package skein.settings

import com.typesafe.config.ConfigFactory
import java.nio.file.Files
import scala.jdk.CollectionConverters.*
import skein.loop.{Knowledge, LoopKind, Planning}
import skein.policy.{PolicyFamily, Role}
import skein.scenario.{PaperDuel, Scenario, ScenarioKind, ScenarioNames, Scenarios, Surround}
import skein.signal.LatencyProfile
import skein.testing.TemporaryFolders
import skein.units.Span

class FlySettingsSuite extends munit.FunSuite, TemporaryFolders:
  private given Scenarios = Scenarios.ours

  private def read(text: String): Either[String, FlySettings] =
    FlySettings.read(ConfigFactory.parseString(text).withFallback(ConfigFactory.load()))

  test("a key that is not known is refused, with its line and the nearest that is"):
    val said = read(
      "skein.fly {\n  duration = 10 s\n  crossing { minimum = 3 }\n  durration = 5 s\n}"
    ).left.getOrElse("")
    assert(clue(said).contains("3: no setting 'skein.fly.crossing.minimum'; the nearest is 'minimum-m'"))
    assert(said.contains("4: no setting 'skein.fly.durration'; the nearest is 'duration'"))

  test("no scenario can have the name of a flight's setting, beside which its own settings stand"):
    val keys = ConfigFactory.defaultReference().getConfig("skein.fly").root.keySet.asScala.toSet
    assertEquals(keys, ScenarioNames.Taken)
    val taken = intercept[IllegalArgumentException](Scenarios(ScenarioKind(FlySettingsSuite.Seed())))
    assertEquals(
      taken.getMessage,
      "expected a scenario's name that is no setting of flights, got 'seed'"
    )

  test("controllers of their own are refused with the paused loop alone, which has a single one"):
    assert(clue(read("skein.fly { decentralised = true, loops = [paused] }")).left.exists(
      _.contains("expected a loop other than paused")
    ))
    assert(read("skein.fly { decentralised = true, loops = [paused, stream] }").isRight)

  test("one name means one model, wherever it is named"):
    for name <- Seq("reduced", "drag", "quadrotor") do
      val plant = VehicleChoice.parse(name, 20).map(_.response.predictor)
      assertEquals(PredictionModel.parse(name).map(_.at(20)), plant)
    assert(clue(
      read("skein.fly.model = drag")
    ).left.exists(_.contains("no setting 'skein.fly.model' any more; it is 'predictor' now")))
    val high = read("skein.fly { predictor = reduced, duel.altitude-m = 5 }")
    assert(clue(high).left.exists(_.contains("reduced holds at 20.0 m")))

  test("in a file, a key outside of skein.fly is refused, since nothing reads it"):
    val file = ConfigFactory.parseString("duration = 10 s\nskein { flyy { seed = 2 } }")
    val said = ConfigMistakes.besideInFile(file, "skein.fly").getOrElse("")
    assert(clue(said).contains("1: no setting 'duration'; the nearest is 'skein.fly'"))
    assert(said.contains("2: no setting 'skein.flyy'"))
    assertEquals(
      ConfigMistakes.besideInFile(ConfigFactory.parseString("skein.fly.planning.step = 50 ms"), "skein.fly"),
      None
    )

  /** Each unreadable line of a file is reported in one line, which states where, what was expected and what
    * was found.
    */
  private def assertTold(text: String, expected: String*)(using munit.Location): Unit =
    val said = read(s"skein.fly {\n$text\n}").left.getOrElse("").linesIterator.toSeq
    assertEquals(said.map(_.replaceAll("^.*String: ", "")), expected)

  test("a null, a list, a single value and settings in one another's places are reported, in one line each"):
    assertTold(
      "scenario = surround, surround { ring-m = null }",
      "2: skein.fly.surround.ring-m: expected a value, got null"
    )
    assertTold("seed = null", "2: skein.fly.seed: expected a value, got null")
    assertTold("loops = stream", "2: skein.fly.loops: expected a list in brackets, got 'stream'")
    assertTold(
      "loops = [stream, [paused], null]",
      "2: skein.fly.loops: expected a list of single values, got a list in it",
      "2: skein.fly.loops: expected a list of single values, got null in it"
    )
    assertTold("period = [100 ms]", "2: skein.fly.period: expected a single value, got a list")
    assertTold(
      "scenario { a = 1 }",
      "2: skein.fly.scenario: expected a single value, got settings in braces"
    )
    assertTold(
      "planning = 3\nsurround = x",
      "2: skein.fly.planning: expected settings in braces, got '3'",
      "3: skein.fly.surround: expected settings in braces, got 'x'"
    )
    assertTold("only-policies = true", "2: skein.fly.only-policies: expected policies beside it, got none")

  test("values of a wrong kind are reported in one line each, whatever reads them"):
    assertTold("seed = many", "2: skein.fly.seed: expected a whole number, got 'many'")
    assertTold("seed = 1e30", "2: skein.fly.seed: expected a whole number, got '1.0E30'")
    assertTold(
      "moves-in-flight = 2.5\nplanning { slowest-share = half, horizon-steps = 99999999999 }",
      "2: skein.fly.moves-in-flight: expected a whole number, got '2.5'",
      "3: skein.fly.planning.horizon-steps: expected a whole number, got '99999999999'",
      "3: skein.fly.planning.slowest-share: expected a finite number, got 'half'"
    )
    assertTold(
      "only-policies = perhaps",
      "2: skein.fly.only-policies: expected true or false, got 'perhaps'"
    )
    assertTold("period = 0 ms", "2: skein.fly.period: expected 1 ms or more, got 0.0 ms")
    assertEquals(read("skein.fly.seed = 1e3").map(_.seed), Right(1000L))
    assert(read("skein.fly { duration = null, deadline = null, solver = null, scene = null }").isRight)

  test("plan is refused if no vehicle plans, and the message lists the policies"):
    assertTold(
      "scenario = forest, loops = [stream, plan]",
      "2: skein.fly.loops: plan: expected a multirotor that can plan, by a policy with a Goal or by one that " +
        "pursues one opponent, got none: Scout1, Scout2, Scout3, Scout4, Scout5 would fly by their own policies"
    )
    assertEquals(
      Planning.told(PaperDuel().fleet),
      Right("plan: Pursuer plans; Evader flies by its own policy")
    )

  test(
    "knows = positions is refused with the loop plan or a solver, which need policies or commands of others"
  ):
    assertTold("knows = some", "2: skein.fly.knows: expected all or positions, got 'some'")
    assertTold(
      "knows = positions, loops = [plan]",
      "2: skein.fly.knows: expected all with the loop plan, which plans against the policies of others, " +
        "got positions"
    )
    assertTold(
      "knows = positions, solver = \"link:vpn\", loops = [stream]",
      "2: skein.fly.knows: expected all with a solver, which is told every command, got positions"
    )

  test("a deadline or images that no chosen loop regards are refused"):
    for loops <- Seq("paused", "plan", "paused, plan") do
      assertTold(
        s"deadline = 50ms, loops = [$loops]",
        s"2: skein.fly.deadline: expected with a loop in which policies decide by the clock, got with $loops alone"
      )
    assertTold(
      "images = [\"front_center@10\"], loops = [paused]",
      "2: skein.fly.images: expected with a loop other than paused, which records none"
    )

  test("how others are predicted is refused if their commands are known"):
    assertTold(
      "strangers = belief",
      "2: skein.fly.strangers: expected knows positions with it, or decentralised, since otherwise all commands " +
        "are known, got belief without"
    )
    assertTold(
      "knows = positions, strangers = belief, loops = [stream]",
      "2: skein.fly.strangers: expected a loop that predicts, such as predictive, got belief without"
    )
    assertTold(
      "knows = positions, strangers = belief, predictor = constant-velocity",
      "2: skein.fly.strangers: expected turn or straight with the predictor constant-velocity, which predicts " +
        "all straight on, got belief"
    )
    assertTold(
      "knows = positions, strangers = none",
      "2: skein.fly.strangers: expected turn or straight or belief, got 'none'"
    )

  test("decentralised is refused if one controller decides for all, or knows the others' commands"):
    def refused(text: String)(why: String) = assertTold(text, s"2: skein.fly.decentralised: expected $why")
    refused("decentralised = true, loops = [stream, plan]"):
      "loops that decide for each vehicle by itself (paused, sequential, futures, stream, predictive), got plan"
    refused("decentralised = true, loops = [stream], wire = mavlink"):
      "vehicles over AirSim's protocol, got mavlink"
    refused("decentralised = true, loops = [stream], solver = \"link:vpn\""):
      "no solver, which decides for all"
    refused("decentralised = true, scenario = crossing, crossing.vehicles = 60"):
      "at most 50 vehicles, got 60"
    def refusedOnly(text: String)(why: String) = assertTold(text, s"2: skein.fly.only: expected $why")
    refusedOnly("only = Pursuer, loops = [stream]")("decentralised with it, got 'Pursuer' without")
    refusedOnly("decentralised = true, only = Hare, loops = [stream]"):
      "one of Evader, Pursuer, got 'Hare'"
    refusedOnly("decentralised = true, only = Evader"):
      "loops other than paused, which stops the time of all vehicles"
    def refusedBetween(text: String)(why: String) = assertTold(text, s"2: skein.fly.between: expected $why")
    refusedBetween("between = vpn, loops = [stream]")("decentralised with it, got 'vpn' without")
    refusedBetween("decentralised = true, loops = [stream], only = Pursuer, between = vpn"):
      "all controllers in this process, which carries their messages, got only Pursuer"
    refusedBetween("between = \"range:far,vpn\"")("a range such as 60m, got 'far'")
    refusedBetween("between = \"rate:1mbit,vpn\""):
      "no rate, since messages have no size, got 'rate:1mbit,vpn'"
    val read = this.read("skein.fly.decentralised = true").fold(fail(_), identity)
    assertEquals(read.loopSettings.knows, Knowledge.Positions)
    assertEquals(
      read.plans.map(plan => (plan.loop == LoopKind.Paused, read.isDecentralised(plan))).distinct,
      Vector((true, false), (false, true))
    )

  test("plan-in-packet is refused if no plan could be sent"):
    def refused(text: String)(why: String) = assertTold(text, s"2: skein.fly.plan-in-packet: expected $why")
    refused("plan-in-packet = true, loops = [stream]"):
      "with the loop predictive, which foresees its commands, got without it"
    refused("plan-in-packet = true, loops = [predictive], wire = mavlink"):
      "vehicles over AirSim's protocol, got mavlink"
    refused("plan-in-packet = true, loops = [predictive], deadline = 20 ms"):
      "without deadline and solver, since the policy is asked for later moments too"
    refused("plan-in-packet = true, loops = [predictive], solver = \"link:vpn\""):
      "without deadline and solver, since the policy is asked for later moments too"
    refused("plan-in-packet = true, loops = [predictive], scenario = convoy"):
      "multirotors, which hold plans, got the car Lead"

  test("the ground truth alone needs no link, and any other loop needs one"):
    assertEquals(
      read("skein.fly { loops = [paused], links = [] }").map(_.plans.map(_.id)),
      Right(Vector("paused-none"))
    )
    assertTold(
      "links = [], loops = [paused, stream]",
      "2: skein.fly.links: expected at least one link for any loop but paused, got none"
    )

  test("a solver has time to answer after its search for plans"):
    def told(key: String) = s"2: skein.fly.$key: expected more than planning.deadline, for which a solver " +
      "searches its plans, 40.0 ms; got 40.0 ms"
    val plans = "loops = [plan], planning.deadline = 40 ms, solver = \"link:vpn\""
    assertTold(s"period = 40 ms, $plans", told("period"))
    assertTold(s"deadline = 40 ms, $plans", told("deadline"))
    assert(read(s"skein.fly { deadline = 41 ms, $plans }").isRight)
    assert(read("skein.fly { period = 40 ms, loops = [plan], planning.deadline = 40 ms }").isRight)

  test("flights have a name each, and one seed: they differ neither in gusts nor in errors of readings"):
    val family = (name: String) => PolicyFile.ofDefaults(Role.Pursuer, PolicyFamily.parse(name).toOption.get)
    val flown  = FlySettings(
      List(LoopKind.Stream, LoopKind.Paused),
      List(LatencyProfile.vpn, LatencyProfile.direct),
      Span.ofSeconds(4),
      Span.ofMillis(100),
      seed = 7,
      policies = List("lead-pursuit", "paper-pursuer", "lead-pursuit").map(family)
    )
    val own = Vector("paused-none", "stream-vpn", "stream-direct")
    assertEquals(
      flown.plans.map(_.id),
      own ++ Seq("lead-pursuit", "paper-pursuer", "lead-pursuit-2").flatMap(name =>
        own.map(id => s"$id-$name")
      )
    )
    assertEquals(flown.plans.map(_.seed).distinct, Vector(7L))

  test("with only-policies the scenario's own policies are omitted"):
    val file = temporaryFolder().resolve("policy.conf")
    Files.writeString(
      file,
      PolicyFile.ofDefaults(Role.Pursuer, PolicyFamily.parse("lead-pursuit").toOption.get).hocon("")
    )
    val text = s"loops = [stream], links = [vpn], policies = [\"$file\"]"
    assertEquals(read(s"skein.fly { $text }").map(_.plans.size), Right(2))
    val alone = read(s"skein.fly { $text, only-policies = true }").map(_.plans)
    assertEquals(alone.map(_.map(_.policy.isDefined)), Right(Vector(true)))

  test("a duration without a unit is refused, with a line that says so"):
    for text <- Seq("skein.fly.duration = 40", "skein.fly.duration = \"40\"") do
      val said = read(text).left.getOrElse("")
      assert(clue(said).contains("expected a duration with unit, such as 40s, got '40'"))

  test("a scene is a bundled scene, a file, or else the scenario's scene"):
    assertEquals(read("").map(_.world.name), Right("empty"))
    assertEquals(read("skein.fly.scenario = forest").map(_.world.name), Right("forest"))
    assertEquals(read("skein.fly { scenario = forest, scene = street }").map(_.world.name), Right("street"))
    val file = temporaryFolder().resolve("scene.conf")
    try
      Files.writeString(file, "objects = [{ pole = [0.1, 5], at = [10, 0] }]")
      val own = read(s"""skein.fly.scene = "$file" """).map(_.world)
      assertEquals(own.map(_.scene.objects.size), Right(1))
      val kept = own.map(NamedScene.recorded(_).map(parameter => parameter.name -> parameter.value).toMap)
      Files.writeString(file, "objects = []")
      // A recording has all of it.
      assertEquals(
        kept.flatMap(NamedScene.ofRecording).map(_.scene.objects.map(_.name)),
        Right(Vector("Pole1"))
      )
      Files.writeString(file, "ground = 7")
      assert(clue(read(s"""skein.fly.scene = "$file" """)).isLeft)
    finally Files.delete(file)
    assert(
      clue(
        read("skein.fly.scene = wood").left.getOrElse("")
      ).contains("expected empty, forest, pursuit, street or a file, got 'wood'")
    )

  test("without a configured deadline there is none"):
    assertEquals(read("").map(_.deadline), Right(None))
    assertEquals(read("skein.fly.deadline = 20 ms").map(_.deadline), Right(Some(Span.ofMillis(20))))

  test("a scenario's settings are under its name; for one that has moved, the error states its new name"):
    val flown = read("skein.fly { scenario = surround, surround { ring-m = 10, vehicles = 4 } }")
    assertEquals(flown.map(_.scenario), Right(Surround(vehicles = 4, ringM = 10)))
    assertEquals(read("").map(_.scenario), Right(PaperDuel()))
    val old = read("skein.fly { pairs = 2, altitude-m = 5 }").left.getOrElse("")
    assert(clue(old).contains("no setting 'skein.fly.pairs' any more; it is 'duel.pairs' now"))
    assert(old.contains("it is 'duel.altitude-m' now"))

  test("a scenario's mistakes state their place, what was expected and what was given"):
    val none = read("skein.fly.scenario = crosing").left.getOrElse("")
    assert(clue(none).contains("got 'crosing'; the nearest is 'crossing'"))
    val text = "skein.fly { scenario = crossing\n crossing { vehicles = many, streams = 3 } }"
    val said = read(text).left.getOrElse("")
    assert(
      clue(said).contains("String: 2: skein.fly.crossing.vehicles: expected a whole number, got 'many'")
    )
    val unsound =
      read("skein.fly { scenario = crossing, crossing { spacing-m = -1, streams = 3 } }").left.getOrElse("")
    assert(clue(unsound).contains("skein.fly.crossing.spacing-m: expected more than 0, got -1.0"))
    assert(unsound.contains("skein.fly.crossing.streams: expected 2 or 4, got 3"))

  test("a flight lasts as long as its scenario states, unless configured otherwise"):
    assertEquals(read("").map(_.duration), Right(Span.ofSeconds(60)))
    assertEquals(read("skein.fly.duration = 5 s").map(_.duration), Right(Span.ofSeconds(5)))

  test("a policy file needs a scenario with its role and another"):
    val file = temporaryFolder().resolve("policy.conf")
    Files.writeString(
      file,
      PolicyFile.ofDefaults(Role.Pursuer, PolicyFamily.parse("lead-pursuit").toOption.get).hocon("")
    )
    assert(read(s"skein.fly.policies = [\"$file\"]").isRight)
    assert(read(s"skein.fly { scenario = surround, policies = [\"$file\"] }").isRight)
    val said = read(s"skein.fly { scenario = formation, policies = [\"$file\"] }").left.getOrElse("")
    assert(
      clue(said).contains(
        "policies: expected with a scenario of a pursuer and vehicles of another role, got with 'formation'"
      )
    )

object FlySettingsSuite:
  final case class Seed() extends Scenario:
    def agents = PaperDuel().agents
