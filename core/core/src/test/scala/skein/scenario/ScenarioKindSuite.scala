package skein.scenario

import skein.policy.{Agent, Role}
import skein.units.*

class ScenarioKindSuite extends munit.FunSuite:

  private case class OverTheRidge(
      scouts: Int = 2,
      heightM: Double = 30,
      isNight: Boolean = false,
      area: String = "north"
  ) extends Scenario:
    def agents: Vector[Agent] = Vector.empty

  private val kind = ScenarioKind(OverTheRidge())

  test("a case class is a kind of scenario, whose fields are the settings"):
    assertEquals(kind.name, "over-the-ridge")
    assertEquals(
      kind.read(Map("scouts" -> "3", "heightM" -> "12.5", "isNight" -> "true", "area" -> "south")),
      Right(OverTheRidge(3, 12.5, true, "south"))
    )
    assertEquals(kind.read(Map("scouts" -> "4")), Right(OverTheRidge(scouts = 4)))

  test(
    "all mistakes in settings are reported together, with the expected and given values and the nearest name"
  ):
    assertEquals(
      kind.read(Map("scuots" -> "3", "heightM" -> "high", "isNight" -> "dusk")),
      Left(Seq(
        "no setting 'scuots'; the nearest is 'scouts'",
        "heightM: expected a number, got 'high'",
        "isNight: expected true or false, got 'dusk'"
      ))
    )

  test("Skein's scenarios are read back from their recorded settings"):
    for scenario <- Seq(
        PaperDuel(pairs = 3, asPublished = true),
        Surround(vehicles = 4),
        Formation(radiusM = 12.5),
        Crossing(streams = 2)
      )
    do
      val recorded = scenario.settings.map((name, value) => scenario.recordedAs(name) -> value).toMap
      assertEquals(Scenarios.ours.ofRecording(scenario.name, recorded), Right(scenario))
      assertEquals(scenario.mistakes, Nil)

  test(
    "recordings of duels keep their older names of settings, and a setting introduced later has its default"
  ):
    assertEquals(PaperDuel().recordedAs("pairs"), "pairs")
    assertEquals(Surround().recordedAs("ringM"), "surround.ringM")
    assertEquals(
      Scenarios.ours.ofRecording("duel", Map("pairs" -> "2", "asPublished" -> "false")),
      Right(PaperDuel(pairs = 2))
    )

  test("vehicles that cannot fly are reported with their names"):
    final case class Pair(second: String = "B", speedMps: Double = 1, north: String = "0", rad: Double = 0)
        extends Scenario:
      def agents: Vector[Agent] =
        for (name, north) <- Vector("A" -> 0.0, second -> this.north.toDouble)
        yield Agent(
          name,
          Role("Scout"),
          MetresPerSecond(speedMps),
          Vector3(north, 0, -10),
          Radians(rad),
          PaperDuel().agents.head.policy
        )
    val pair                                    = ScenarioKind(Pair())
    def mistake(setting: String, value: String) = pair.read(Map(setting -> value)).left.map(_.mkString)
    assertEquals(pair.read(Map.empty), Right(Pair()))
    assertEquals(mistake("second", "A"), Left("agents: expected a name of its own for each, got 'A' twice"))
    assertEquals(
      mistake("speedMps", "-1"),
      Left("agents: expected a speed from 0 to 100.0 m/s, got -1.0 m/s, of A")
    )
    assertEquals(
      mistake("north", "NaN"),
      Left("agents: expected finite numbers as a start, got NaN, 0.0, -10.0, of B")
    )
    assertEquals(
      mistake("rad", "90"),
      Left("agents: expected a heading at the start in radians, from -2π to 2π, got 90.0, of A")
    )

  test("an exception in a scenario's own code is reported with the scenario's name and the line"):
    final case class Broken(where: String = "") extends Scenario:
      require(where != "constructor", "no such place")
      private def mayFail(place: String): Unit = if where == place then sys.error(s"in $place")
      private val apart         = Series("apart", "m")(_ => instant => { mayFail("series"); instant })
      def agents: Vector[Agent] = { mayFail("agents"); PaperDuel().agents }
      override def limits: Vector[Limit]     = { mayFail("limits"); Vector.empty }
      override def duration: Span            = { mayFail("duration"); super.duration }
      override def title: String             = { mayFail("title"); name }
      override def series: Vector[Series]    = Vector(apart)
      override def measures: Vector[Measure] = Vector(Measure("own", "")(_ => { mayFail("measure"); None }))
    val broken                              = ScenarioKind(Broken())
    def told(failing: => Any)               = intercept[OwnFailure](failing).getMessage
    def isOf(text: String, mistake: String) =
      assert(clue(
        text
      ).matches(s"the scenario broken failed: java.lang.$mistake \\(ScenarioKindSuite.scala:\\d+\\)"))
    for place <- Seq("agents", "limits", "duration", "title") do
      isOf(told(broken.read(Map("where" -> place))), s"RuntimeException: in $place")
    // A search has read such a scenario before.
    assertEquals(broken.candidate(Map("where" -> "limits")), Right(Broken("limits")))
    isOf(
      told(broken.read(Map("where" -> "constructor"))),
      "IllegalArgumentException: requirement failed: no such place"
    )
    val still  = Seq(Instant.Epoch, Instant.Epoch + Span.ofSeconds(1)).map((_, Vector3.Zero)).toVector
    val tracks = Tracks.of(Vector(Track.ofPositions("One", "Scout", still))).get
    for place <- Seq("series", "measure") do
      isOf(told(Result.of(Broken(place), tracks)), s"RuntimeException: in $place")

  test("settings that cannot be simulated are reported by name"):
    assertEquals(
      Crossing(vehicles = 1, streams = 3, spacingM = -1).mistakes,
      Seq(
        "vehicles: expected 2 to 100, got 1",
        "spacingM: expected more than 0, got -1.0",
        "streams: expected 2 or 4, got 3"
      )
    )

  test("an unknown kind is reported with the nearest known one, and no two kinds may share a name"):
    assertEquals(
      Scenarios.ours.kind("crosing"),
      Left(
        "expected duel, surround, formation, crossing, forest, " +
          "convoy, shadow, got 'crosing'; the nearest is 'crossing'"
      )
    )
    intercept[IllegalArgumentException](Scenarios(ScenarioKind(Surround()), ScenarioKind(Surround(4))))

  test("the name of a scenario must be one word, usable in recordings and configurations"):
    final case class Called(override val name: String = "") extends Scenario:
      def agents: Vector[Agent] = Vector.empty
    for name <- Seq("ridge, by night", "ridge.north", "ridge {}", "") do
      val refused = intercept[IllegalArgumentException](Scenarios(ScenarioKind(Called(name))))
      assert(refused.getMessage.contains(s"got '$name'"), refused.getMessage)
    assertEquals(Scenarios(ScenarioKind(Called("über-2_b"))).names, Vector("über-2_b"))

  test("the distance between two words is the number of letters to change"):
    assertEquals(Nearest.distance("durration", "duration"), 1)
    assertEquals(Nearest.distance("", "loops"), 5)
    assertEquals(Nearest.distance("seed", "period"), 4)
