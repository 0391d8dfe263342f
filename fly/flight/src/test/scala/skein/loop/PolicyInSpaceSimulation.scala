package skein.loop

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.ExecutionContext
import skein.policy.*
import skein.record.{MemoryRecorder, Recording, Samples}
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*
import skein.vtime.VirtualTime

/** Policies in three dimensions, with their own memories and actions, through whole loops in virtual time. */
class PolicyInSpaceSimulation extends munit.FunSuite, Unhurried:

  /** Climbs to an altitude, remembers that it was there, and descends to another. */
  private final case class UpAndDown(topM: Double, bottomM: Double) extends Policy:
    type Memory = Boolean
    def start: Boolean                                                  = false
    def choose(seen: Observation, wasAtTop: Boolean): (Action, Boolean) =
      val altitudeM = -seen.own.kinematics.positionNed.z
      val atTop     = wasAtTop || altitudeM >= topM
      val goalM     = if atTop then bottomM else topM + 1
      if atTop && (altitudeM - bottomM).abs < 0.3 then (Action.Hover, atTop)
      else (Action.Velocity(Vector3(0, 0, if altitudeM < goalM then -2 else 2)), atTop)

  /** Holds its position and looks at the other vehicle. */
  private object LookAtTheOther extends Policy:
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      val to = seen.vehicles(seen.opponent).kinematics.positionNed - seen.own.kinematics.positionNed
      (Action.Turn(Yaw.Towards(Radians(StrictMath.atan2(to.y, to.x)))), ())

  private def agent(name: String, north: Double, east: Double, policy: Policy) =
    Agent(name, Role.Traveller, MetresPerSecond(2), Vector3(north, east, -20), Radians(0), policy)

  private val both = Fleet(Vector(
    agent("Evader", 0, 0, UpAndDown(topM = 26, bottomM = 15)),
    agent("Pursuer", 10, 10, LookAtTheOther)
  ))

  private def fly(
      kind: LoopKind,
      scenario: Fleet = both,
      settings: LoopSettings = LoopSettings()
  ): Recording = VirtualTime
    .run(seed = 3): system =>
      given ActorSystem      = system
      given ExecutionContext = system.dispatcher
      val clock              = Clock.ofNanos(VirtualTime.clock(system))
      val world              = FarQuadrotors(scenario, LatencyProfile.vpn, 3, clock)
      val heading            = Samples.heading.copy(flight = Samples.heading.flight.copy(loop = kind.label))
      val recorder           = MemoryRecorder(heading)
      val team               = Team(scenario, world.ports, clock, recorder, settings)
      Flight.start(kind, team, Some(world), Span.ofSeconds(30), clock, recorder).outcome.map(_ =>
        recorder.recording
      )
    .value

  private def downs(recording: Recording, vehicle: String) =
    recording.readings.filter(_.vehicle == vehicle).map(reading => -reading.state.value.positionNed.z)

  for kind <-
      Seq(LoopKind.Paused, LoopKind.Sequential, LoopKind.Futures, LoopKind.Stream, LoopKind.Predictive)
  do
    test(
      s"${kind.label}: a policy climbs, remembers, sinks and hovers; another turns to look at that vehicle"
    ):
      val recording = fly(kind)
      val altitudes = downs(recording, "Evader")
      assert(altitudes.max >= 26 && altitudes.max < 29, s"the top was ${altitudes.max} m")
      assertEqualsDouble(altitudes.last, 15, 1)
      val looking = recording.readings.filter(_.vehicle == "Pursuer").last.state.value
      val q       = looking.orientation
      val yaw     = math.toDegrees(math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z)))
      assertEqualsDouble(yaw, -135, 3)
      assert(recording.decisions.exists(_.action.contains(Action.Hover)))

  for kind <- Seq(LoopKind.Paused, LoopKind.Sequential, LoopKind.Futures, LoopKind.Stream) do
    test(s"${kind.label}: a replay repeats the decisions to the last bit"):
      val recording = fly(kind)
      assert(recording.decisions.size > 150, s"${recording.decisions.size} decisions")
      assertEquals(Replay(both, recording).firstDifference, None)

  test("if each vehicle predicts the whole team, only its own predictions are compared with readings"):
    val predictions = fly(LoopKind.Predictive).predictions
    assertEquals(
      predictions.map(one => (one.decider, one.vehicle)).toSet,
      Set("Evader", "Pursuer").map(name => (name, name))
    )

  test(
    "as published, every view is decided on, then paced; else views are paced, and all decisions are sent"
  ):
    val published                    = LoopSettings().asPublished
    def flown(is: Boolean)           = fly(LoopKind.Stream, settings = published.copy(decideThenPace = is))
    def unsent(recording: Recording) = recording.decisions.size - recording.commands.size
    val (decided, paced)             = (unsent(flown(is = true)), unsent(flown(is = false)))
    assert(decided > 100 && paced < 10, s"not sent: $decided of the ones, $paced of the others")

  test("a vehicle may fly alone"):
    val alone     = Fleet(Vector(both.agents.head))
    val altitudes = downs(fly(LoopKind.Stream, alone), "Evader")
    assert(altitudes.max >= 26)
    assertEqualsDouble(altitudes.last, 15, 1)
