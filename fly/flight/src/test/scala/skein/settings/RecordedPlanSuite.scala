package skein.settings

import skein.loop.{Fallback, Knowledge, LoopKind, PlanSettings, Strangers}
import skein.policy.Role
import skein.record.{ParameterRow, Recording, RecordingHeader, Samples}
import skein.scenario.{PaperDuel, Scenarios}
import skein.signal.LatencyProfile
import skein.units.*
import skein.vehicle.SensorNoise

/** Settings as a recording stores them: files of all versions use equal names. */
class RecordedPlanSuite extends munit.FunSuite:
  private given Scenarios = Scenarios.ours

  private val usual =
    FlySettings(List(LoopKind.Stream), List(LatencyProfile.vpn), Span.ofSeconds(60), Span.ofMillis(100), -7)

  private val set = usual.copy(
    scene = Some(right(NamedScene.read("forest"))),
    planning = PlanSettings(searches = 3),
    predictor = right(PredictionModel.parse("drag")),
    movesInFlight = 6,
    planInPacket = true,
    knows = Knowledge.Positions,
    strangers = Strangers.Belief,
    decentralised = true,
    only = Some("Pursuer"),
    between = Some(right(VehicleLink.parse("range:60m,loss:10%/4,vpn"))),
    plant = right(SimulatedBody.recorded("mujoco:gone.xml")),
    sensors = Some(right(SensorNoise.parse("position=0.1,dropout=2%"))),
    wire = Wire.Mavlink,
    images = List(ImageSource.Seen, right(ImageSource.parse("front@10"))),
    deadline = Some(Span.ofMillis(20)),
    fallback = Fallback.Hover
  )

  private def right[A](answer: Either[String, A]): A = answer.fold(fail(_), identity)

  private def plan(settings: FlySettings) = settings.plans.head

  private def read(parameters: Seq[ParameterRow]) =
    RecordedPlan.of(Recording(RecordingHeader(Samples.heading.flight, Nil, parameters)))

  test("a recording keeps every setting that was set, and the policy and solver of its flight"):
    val solver = right(SolverChoice.parse("link:vpn"))
    val file   = PolicyFile.paperOf(Role.Pursuer)
    val flown  = plan(set).copy(policy = Some(ChosenPolicy("own", file)), solver = Some(solver))
    val all    = RecordedPlan.parameters(set, flown)
    assertEquals(
      all.drop(PaperDuel().settings.size).map(row => row.name -> row.value),
      Seq(
        "scene"          -> "forest",
        "planning"       -> PlanSettings(searches = 3).text,
        "predictor"      -> "drag",
        "movesInFlight"  -> "6",
        "planInPacket"   -> "true",
        "knows"          -> "positions",
        "strangers"      -> "belief",
        "decentralised"  -> "true",
        "only"           -> "Pursuer",
        "between"        -> "range:60m,loss:10%/4,vpn",
        "plant"          -> "mujoco:gone.xml",
        "sensors"        -> "position=0.1,dropout=2%",
        "wire"           -> "mavlink",
        "solver"         -> "link:vpn",
        "images"         -> "seen front@10",
        "deadlineNs"     -> "20000000",
        "fallback"       -> "hover",
        "policy"         -> "own",
        "policy.pursuer" -> file.text
      )
    )
    val again = right(read(all))
    // Bodies and scenes have no equality of their own.
    assertEquals(again.settings.plant.text, set.plant.text)
    assertEquals(again.settings.scene.map(_.name), Some("forest"))
    assertEquals(again.settings.copy(plant = set.plant, scene = set.scene), set)
    assertEquals((again.plan.solver, again.plan.policy.map(_.name)), (Some(solver), Some("own")))

  test("defaults are recorded only for settings that older versions recorded, and are read back as defaults"):
    val all = RecordedPlan.parameters(usual, plan(usual))
    assertEquals(
      all.drop(PaperDuel().settings.size).map(_.name),
      Seq("planning", "predictor", "movesInFlight")
    )
    assertEquals(right(read(all)).settings, usual.copy(scene = Some(NamedScene.Empty)))
    assertEquals(right(read(Nil)).settings, usual.copy(scene = Some(NamedScene.Empty)))

  test("an invalid parameter is reported with what was expected"):
    for
      (name, wrong, expected) <- Seq(
        ("movesInFlight", "few", "expected a whole number, got 'few'"),
        ("movesInFlight", "33", "expected 1 to 32, got 33"),
        ("wire", "x", "expected airsim or mavlink, got 'x'"),
        ("deadlineNs", "0", "expected nanoseconds, got '0'"),
        ("learningExplore", "x", "expected a number, got 'x'")
      )
    do
      assertEquals(
        read(Seq(ParameterRow(name, wrong))).map(_ => ()),
        Left(s"its parameter '$name': $expected")
      )
