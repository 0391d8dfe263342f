package skein.flight

import scala.collection.mutable.ArrayBuffer
import skein.forward.{Engagement, LoopObserver, Rollout, VelocityResponses}
import skein.loop.{LoopKind, LoopSettings, LoopTimings}
import skein.record.ReadingRow
import skein.policy.*
import skein.scenario.{Crossing, Formation, Known, PaperDuel, Scenario, Surround}
import skein.settings.{FlightPlan, FlySettings}
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*

/** Given the delays of a flight in virtual time, the scalar forward simulation reproduces it, to the last
  * bit: every vehicle is read at equal nanoseconds and positions, and receives equal headings.
  */
class RolloutParitySimulation extends munit.FunSuite, Unhurried:
  /** Time until the pursuer has passed, turned and come near again. */
  private val once = Span.ofSeconds(15)

  private val minute = Span.ofSeconds(60)

  private def settings(
      loop: LoopKind,
      link: LatencyProfile,
      scenario: Scenario,
      duration: Span
  ) = FlySettings(
    List(loop),
    List(link),
    duration,
    Span.ofMillis(100),
    1,
    scenario
  )

  /** One event: its vehicle, its index, its time, and its values. */
  private case class Note(vehicle: Int, number: Int, at: Span, values: Double*):
    override def toString =
      f"vehicle $vehicle number $number at ${at.toSeconds}%.9f s: ${values.mkString(", ")}"

  private def check(
      loop: LoopKind,
      link: LatencyProfile,
      seed: Long,
      scenario: Scenario = PaperDuel(),
      duration: Span = once
  ): Unit =
    val asked  = settings(loop, link, scenario, duration)
    val flown  = TappedFlight.fly(asked, FlightPlan("parity", loop, link, seed))
    val every  = LoopSettings.every(Span.ofMillis(100))
    val timing =
      LoopTimings
        .of(loop, if scenario.isAsPublished then every.asPublished else every)
        .getOrElse(fail(s"${loop.label} has no timing"))
    val fleet    = asked.fleet
    val vehicles = fleet.agents.map(_.name)
    val clue     = s"${loop.label} over ${link.name}, seed $seed"

    val readings, commands = ArrayBuffer.empty[Note]
    val headings           = fleet.agents.map(_.startHeading.value).toArray
    val observer           = new LoopObserver:
      override def read(vehicle: Int, number: Int, atNs: Long, x: Double, y: Double, z: Double): Unit =
        readings += Note(vehicle, number, Span.ofNanos(atNs), x, y, z)
      override def commanded(vehicle: Int, number: Int, atNs: Long, action: Action): Unit =
        headings(vehicle) = action.headingRad(headings(vehicle))
        val velocity = fleet.agents(vehicle).velocityNed(headings(vehicle), Some(action.speed))
        commands += Note(vehicle, number, Span.ofNanos(atNs), velocity.x, velocity.y)
    val model   = VelocityResponses.quadrotor(hoveredS = flown.hovered.toSeconds)
    val rollout = Rollout(Engagement.inSpace(fleet, duration.toSeconds), timing, flown.delays, model)
    val _       = rollout.fly(0, observer = observer)

    def same(what: String, recorded: Seq[Note], again: Seq[Note]): Unit =
      val (expected, actual) = (sorted(recorded, duration), sorted(again, duration))
      assert(expected.nonEmpty, s"$clue: no $what")
      for (e, a) <- expected.zip(actual) do
        assert(e == a, s"$clue: $what\nflown   $e\nrollout $a")
      assertEquals(actual.size, expected.size, s"$clue: $what")

    val startS = if loop == LoopKind.Paused then recordedStart(flown) else flown.startedAt
    val read   = flown.recording.readings.map: (reading: ReadingRow) =>
      val place = reading.state.value.positionNed
      Note(
        vehicles.indexOf(reading.vehicle),
        reading.sequence.toInt,
        reading.state.validAt.since(startS),
        place.x,
        place.y,
        place.z
      )
    // A recorded command bears the number of its decision, and not every decision is sent.
    val sent = flown.recording.commands
      .groupBy(_.vehicle)
      .toSeq
      .flatMap: (vehicle, commands) =>
        for (command, number) <- commands.sortBy(_.sentAt.toNanos).zipWithIndex
        yield Note(
          vehicles.indexOf(vehicle),
          number,
          command.sentAt.since(startS),
          command.velocityNorth.value,
          command.velocityEast.value
        )
    same("readings", read, readings.toSeq)
    if loop != LoopKind.Paused then same("commands", sent, commands.toSeq)

  /** Events in the order of time, without those of the last moments. */
  private def sorted(notes: Seq[Note], duration: Span): Seq[Note] =
    notes.filter(_.at < duration - Span.ofMillis(1)).sortBy(note =>
      (note.vehicle, note.at.toNanos, note.number)
    )

  private def recordedStart(flown: TappedFlight): Instant = flown.recording.readings.head.state.validAt

  test("forward simulation reproduces paused, which has no delays"):
    check(LoopKind.Paused, LatencyProfile.none, 1)

  for
    (loop, link, seed) <- Seq(
      (LoopKind.Sequential, "direct", 1),
      (LoopKind.Sequential, "vpn", 2),
      (LoopKind.Futures, "direct", 1),
      (LoopKind.Futures, "vpn", 2),
      (LoopKind.Stream, "direct", 1),
      (LoopKind.Stream, "vpn", 2),
      (LoopKind.Stream, "vpn-mixed", 3),
      // Answers overtake one another, arrive too late, and requests are skipped.
      (LoopKind.Stream, "lognormal:150ms,0.8", 1),
      (LoopKind.Predictive, "direct", 1),
      (LoopKind.Predictive, "vpn", 2),
      (LoopKind.Predictive, "lognormal:150ms,0.8", 1),
      (LoopKind.Sequential, "loss:5%,vpn", 1),
      (LoopKind.Sequential, "loss:5%/4,outage:1s/10s,vpn", 1),
      (LoopKind.Futures, "loss:5%/4,direct", 3),
      (LoopKind.Futures, "outage:1s/10s,vpn", 1),
      // Time-outs end at the time of a tick.
      (LoopKind.Stream, "loss:5%/4,vpn", 1),
      (LoopKind.Stream, "loss:5%/4,outage:1s/10s,vpn", 3),
      (LoopKind.Predictive, "loss:5%/4,vpn", 1),
      (LoopKind.Predictive, "outage:1s/10s,vpn", 1)
    )
  do
    test(s"forward simulation reproduces ${loop.label} over $link"):
      check(loop, profile(link), seed, duration = if link == "vpn-mixed" then minute else once)

  test("forward simulation reproduces stream over vpn at a low altitude, where vehicles respond faster"):
    check(LoopKind.Stream, profile("vpn"), 4, PaperDuel(altitudeM = 6))

  for (team, loop) <- Seq(
      Surround()             -> LoopKind.Paused,
      Surround()             -> LoopKind.Stream,
      Surround()             -> LoopKind.Sequential,
      Formation()            -> LoopKind.Sequential,
      Formation()            -> LoopKind.Stream,
      Crossing(vehicles = 8) -> LoopKind.Stream,
      Crossing(vehicles = 8) -> LoopKind.Futures,
      Formation()            -> LoopKind.Predictive
    )
  do
    test(
      s"forward simulation reproduces ${loop.label} for ${team.name}, whose policies regard all vehicles"
    ):
      val link = if loop == LoopKind.Paused then LatencyProfile.none else LatencyProfile.vpn
      check(loop, link, 5, team, duration = Span.ofSeconds(8))

  test(
    "forward simulation reproduces futures over direct for twenty vehicles, with eighty overlapping tasks"
  ):
    check(
      LoopKind.Futures,
      LatencyProfile.direct,
      1,
      Crossing(),
      Span.ofSeconds(3)
    )

  // Every event coincides, to the nanosecond, with another: readings, ticks, time-outs of 500 ms. Left out
  // are futures over none and 50 ms, where tasks of both vehicles end simultaneously and the flight's streams
  // determine which decides first.
  private val ties = Seq(
    LoopKind.Sequential -> Seq("none", "constant:100ms", "constant:400ms", "constant:500ms"),
    LoopKind.Futures    -> Seq("constant:100ms", "constant:400ms", "constant:500ms"),
    LoopKind.Stream     -> Seq("none", "constant:100ms", "constant:400ms", "constant:500ms"),
    LoopKind.Predictive -> Seq("none", "constant:500ms")
  )
  for
    (loop, links) <- ties
    link          <- links
  do
    test(s"forward simulation reproduces ${loop.label} over $link, where events coincide"):
      check(loop, profile(link), 1, duration = Span.ofSeconds(6))

  for loop <- Seq(LoopKind.Futures, LoopKind.Stream) do
    test(
      s"forward simulation reproduces ${loop.label} over vpn with two duels, each against the nearest opponent"
    ):
      check(loop, LatencyProfile.vpn, 1, PaperDuel(pairs = 2))

  for loop <- Seq(LoopKind.Sequential, LoopKind.Futures, LoopKind.Stream, LoopKind.Predictive) do
    test(s"forward simulation reproduces ${loop.label} over vpn with four kinds of policies, with memories"):
      check(loop, LatencyProfile.vpn, 2, AnyPolicies(), Span.ofSeconds(8))

  test("forward simulation reproduces paused with four kinds of policies"):
    check(LoopKind.Paused, LatencyProfile.none, 2, AnyPolicies(), Span.ofSeconds(8))

  for loop <- Seq(LoopKind.Sequential, LoopKind.Futures, LoopKind.Stream, LoopKind.Predictive) do
    test(s"forward simulation reproduces ${loop.label} over vpn in three dimensions, with climbs and turns"):
      check(loop, LatencyProfile.vpn, 3, InSpace(), Span.ofSeconds(8))

  test("forward simulation reproduces paused in three dimensions"):
    check(LoopKind.Paused, LatencyProfile.none, 3, InSpace(), Span.ofSeconds(8))

  for loop <- Seq(LoopKind.Sequential, LoopKind.Stream) do
    test(
      s"${loop.label} over vpn: a scenario ends in forward simulation within a period of its flight's end"
    ):
      val asked   = settings(loop, LatencyProfile.vpn, EndsInSpace(), Span.ofSeconds(12))
      val flown   = TappedFlight.fly(asked, FlightPlan("parity", loop, LatencyProfile.vpn, 4))
      val timing  = LoopTimings.of(loop, LoopSettings.every(Span.ofMillis(100))).get
      val model   = VelocityResponses.quadrotor(hoveredS = flown.hovered.toSeconds)
      var last    = Span.Zero
      val rollout = Rollout(Engagement.ofScenario(asked.scenario, 12), timing, flown.delays, model)
      rollout.fly(
        0,
        observer = new LoopObserver:
          override def commanded(vehicle: Int, number: Int, atNs: Long, action: Action) =
            last = Span.ofNanos(atNs)
      ): Unit
      val sent = flown.recording.commands.map(_.sentAt.since(flown.startedAt).toSeconds).max
      assert(sent > 2 && sent < 8, s"it was flown for $sent s")
      assertEqualsDouble(last.toSeconds, sent, 0.1)

  // If delays are equal in both directions, a flight knows the true ages of its readings.
  for loop <- Seq(LoopKind.Sequential, LoopKind.Stream) do
    test(
      s"forward simulation reproduces ${loop.label} over 100 ms, with a policy that depends on ages and the time"
    ):
      check(loop, profile("constant:100ms"), 1, AnyPolicies(byAges = true), Span.ofSeconds(6))

  test(
    "forward simulation reproduces stream over vpn as published: spread requests, a decision at each answer"
  ):
    check(LoopKind.Stream, LatencyProfile.vpn, 3, PaperDuel(asPublished = true))

  private def profile(name: String): LatencyProfile =
    LatencyProfile.parse(name, Left(_)).fold(error => fail(error.message), identity)

final case class AnyPolicies(byAges: Boolean = false) extends Scenario:
  import AnyPolicies.*
  private def agent(i: Int, role: Role, policy: Policy) =
    Agent(s"V$i", role, MetresPerSecond(5 + i), Vector3(14 * i, 7 * (i % 2), -20), Radians(0.3 * i), policy)

  def agents: Vector[Agent] = Vector(
    agent(0, Role.Evader, Weaving(0.4)),
    agent(1, Role.Pursuer, if byAges then Ages else Mirror),
    agent(2, Role.Pursuer, Trailing),
    agent(3, Role.Pursuer, Surrounding(0, 7, 8)),
    agent(4, Role.Pursuer, LeadPursuit(0.5))
  )

object AnyPolicies:
  private def towards(seen: Observation, vehicle: Int) =
    seen.vehicles(vehicle).kinematics.positionNed - seen.own.kinematics.positionNed

  private def heading(seen: Observation, way: Vector3, by: Double) =
    Action.Along(Radians(StrictMath.atan2(way.y, way.x) + by), seen.cruise, seen.startDown)

  final case class Phase(angle: Double, isLeft: Boolean)

  /** Flees to the left and to the right in turn. */
  final case class Weaving(rate: Double) extends Policy:
    type Memory = Phase
    def start: Phase                                              = Phase(0.25, true)
    def choose(seen: Observation, memory: Phase): (Action, Phase) =
      val angle = memory.angle + rate * seen.elapsed.toSeconds * (if memory.isLeft then 1 else -1)
      val next  =
        if angle.abs > 0.5 then Phase(angle.min(0.5).max(-0.5), !memory.isLeft) else memory.copy(angle)
      (heading(seen, towards(seen, seen.opponent) * -1, next.angle), next)

  /** Follows the last commands of itself and its opponent. */
  case object Mirror extends Policy:
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      val (other, own) = (seen.headings(seen.opponent).value, seen.headings(seen.self).value)
      val way          = towards(seen, seen.opponent)
      val north        = way.x / 5 + 2 * StrictMath.cos(other) + StrictMath.cos(own)
      val east         = way.y / 5 + 2 * StrictMath.sin(other) + StrictMath.sin(own)
      (Action.VelocityAt(north, east, seen.startDown), ())

  /** Remembers three bearings of the first vehicle. */
  case object Trailing extends Policy:
    type Memory = Vector[Double]
    def start: Vector[Double]                                                       = Vector(0.0, 0.0, 0.0)
    def choose(seen: Observation, memory: Vector[Double]): (Action, Vector[Double]) =
      val way  = towards(seen, 0)
      val next = memory.tail :+ StrictMath.atan2(way.y, way.x)
      val mean = next.map(_ - next.last).sum / next.size
      (heading(seen, way, 0.2 * mean.max(-1).min(1)), next)

  case object Ages extends Policy:
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      val other = seen.vehicles(seen.opponent)
      val way   = towards(seen, seen.opponent) + other.kinematics.velocityNed * other.age.toSeconds
      (heading(seen, way, StrictMath.sin(seen.time.toSeconds)), ())

final case class InSpace() extends Scenario:
  import InSpace.*
  private def agent(i: Int, policy: Policy) =
    Agent(
      s"V$i",
      Role("Scout"),
      MetresPerSecond(4 + i),
      Vector3(9 * i, 5 * i, -12 - 3 * i),
      Radians(0),
      policy
    )

  def agents: Vector[Agent] =
    Vector(
      agent(0, Helix),
      agent(1, Above(0, Yaw.Forward)),
      agent(2, Above(1, Yaw.Turning(0.3))),
      agent(3, Stairs)
    )

/** Ends when the first vehicle has climbed by four metres. */
final case class EndsInSpace() extends Scenario:
  def agents: Vector[Agent]                  = InSpace().agents
  override def isOver(known: Known): Boolean = known.vehicles.head.kinematics.positionNed.z < -16

object InSpace:
  /** Climbs and sinks along a circle, nose ahead. */
  private case object Helix extends Policy:
    type Memory = Double
    def start: Double                                               = 0
    def choose(seen: Observation, memory: Double): (Action, Double) =
      val angle      = memory + 0.4 * seen.elapsed.toSeconds
      val (cos, sin) = (StrictMath.cos(angle), StrictMath.sin(angle))
      (Action.Velocity(Vector3(4 * cos, 4 * sin, -1.5 * sin - 0.5), Yaw.Forward), angle)

  /** Flies to the place three metres above another vehicle. */
  private final case class Above(other: Int, yaw: Yaw) extends Policy:
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      val way =
        seen.vehicles(other).kinematics.positionNed + Vector3(0, 0, -3) - seen.own.kinematics.positionNed
      val speed = seen.cruise.value.min(way.norm)
      (Action.Velocity(way * (speed / way.norm.max(1e-3)), yaw), ())

  /** Holds one altitude after the other. */
  private case object Stairs extends Policy:
    type Memory = Double
    def start: Double                                               = 0
    def choose(seen: Observation, memory: Double): (Action, Double) =
      val timeS = memory + seen.elapsed.toSeconds
      val down  = Metres(seen.startDown.value - 2 * math.floor(timeS / 2))
      (Action.VelocityAt(3, -1, down, Yaw.Towards(Radians(0.5))), timeS)
