package skein.flight

import skein.loop.LoopKind
import skein.policy.*
import skein.scenario.*
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*

/** Moves to positions: the simulator's flight compared with its prediction. */
class PositionPredictionSimulation extends munit.FunSuite, Unhurried:
  private final case class Corners(places: Vector[Vector3], yaw: Yaw) extends Policy:
    type Memory = Int
    def start: Int                                            = 0
    def choose(seen: Observation, memory: Int): (Action, Int) =
      val here = seen.own.kinematics.positionNed
      val next = if (places(memory) - here).norm < 2 then (memory + 1) % places.size else memory
      (Action.Position(places(next), seen.cruise, yaw), next)

  /** Two vehicles fly from corner to corner, with changes of altitude. */
  private final case class Patrol(yaw: Yaw) extends Scenario:
    private def patrol(east: Double) = Corners(
      Vector((30, 0, -10), (30, 30, -20), (0, 30, -10), (0, 0, -20))
        .map((x, y, z) => Vector3(x, y + east, z)),
      yaw
    )
    def agents: Vector[Agent] = Vector("One" -> 0.0, "Two" -> 50.0).map: (name, east) =>
      Agent(name, Role.Traveller, MetresPerSecond(4), Vector3(0, east, -10), Radians(0), patrol(east))
    override def duration: Span = Span.ofSeconds(40)

  private def errorsM(yaw: Yaw): Vector[Double] =
    val scenario = Patrol(yaw)
    val settings = FlySettings(
      List(LoopKind.Predictive),
      List(LatencyProfile.vpn),
      scenario.duration,
      Span.ofMillis(100),
      1,
      scenario
    )
    val flown = VirtualFlights.fly(settings, settings.plans.last).fold(fail(_), identity)
    flown.recorder.recording.predictions.map(_.error.value).sorted

  for yaw <- Seq(Yaw.Still, Yaw.Forward) do
    test(s"a vehicle that flies to positions, yaw $yaw, is predicted within two centimetres over vpn"):
      val errors = errorsM(yaw)
      assert(errors.sizeIs > 300, s"only ${errors.size} predictions were verified")
      assert(
        errors(errors.size * 95 / 100) < 0.02,
        s"95 of 100 lie within ${errors(errors.size * 95 / 100)} m"
      )
