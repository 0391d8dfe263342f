package skein.identify

import skein.forecast.Structure
import skein.forward.{DelayTable, Pair, LoopTiming, Rollout, Vehicle, VelocityResponse, VelocityResponses}
import skein.policy.{Action, Role}
import skein.simd.WorldRandom
import skein.vehicle.ReducedModel

/** Compares the identified models of the built-in quadrotor with the quadrotor itself, in the paper's duel
  * over the VPN.
  */
class AirSimModelSuite extends munit.FunSuite:

  /** Commands and motion of both vehicles in episodes with the full quadrotor. */
  private lazy val flights: Vector[TimeHistory] =
    val flown                    = Vector.newBuilder[TappedVehicle]
    val tapped: VelocityResponse = () =>
      val vehicle = TappedVehicle(VelocityResponses.quadrotor().create())
      flown += vehicle
      vehicle
    val _ = Rollout(
      Pair.paper.engagement,
      LoopTiming.Stream(),
      DelayTable.vpn,
      tapped
    ).fly(WorldRandom.key(1, 0, 0))
    flown.result().zip(Seq(Role.Evader, Role.Pursuer)).map((vehicle, role) => vehicle.flown(role.toString))

  test(
    "the identified model follows the full quadrotor through the duel: 95 % within 0.1 m after 1 s, 0.7 " +
      "m after 5 s"
  ):
    val truth  = flights.map(HorizonErrors.reflown(_))
    val errors = HorizonErrors.of(ReducedModel.AirSim, truth)
    assertEquals(errors.map(_.horizonS), Vector(1.0, 2.0, 5.0))
    assert(
      errors(0).positionP95M < 0.1 && errors(1).positionP95M < 0.25 && errors(2).positionP95M < 0.7,
      errors
    )
    assert(errors(0).positionP50M < 0.02 && errors(2).positionP50M < 0.12, errors)

  test("identification from the quadrotor's flights gives the named defaults again"):
    val named = Map(Structure.Lag -> ReducedModel.AirSimLag, Structure.Drag -> ReducedModel.AirSim)
    for (structure, model) <- named do
      val identified = Identification.of(flights.map(HorizonErrors.reflown(_)), structure)
      val found      = identified.map(_.plant).fold(fail(_), identity) match
        case model: ReducedModel => model
        case other               => fail(s"$structure: expected a reduced model, got $other")
      assertEqualsDouble(found.gain, model.gain, 0.03, s"$structure: $found")
      assertEqualsDouble(found.lagS, model.lagS, 0.1 * model.lagS, s"$structure: $found")
      assertEqualsDouble(found.deadTimeS, model.deadTimeS, 0.03, s"$structure: $found")
      assertEqualsDouble(found.dragPerM, model.dragPerM, 0.002, s"$structure: $found")

private final class TappedVehicle(vehicle: Vehicle) extends Vehicle:
  private val arrivals              = Vector.newBuilder[ArrivedCommand]
  private val samples               = Vector.newBuilder[Sample]
  private var now, down, nextSightS = 0.0

  def flown(name: String): TimeHistory = TimeHistory(name, samples.result(), arrivals.result(), down)

  def start(x: Double, y: Double, z: Double): Unit =
    vehicle.start(x, y, z)
    down = z

  def act(action: Action): Unit =
    vehicle.act(action)
    action.byVelocity match
      case velocity: Action.VelocityAt => arrivals += ArrivedCommand(now, velocity)
      case _                           => ()

  def advance(timeS: Double): Unit =
    vehicle.advance(timeS)
    now = timeS
    if timeS >= nextSightS then
      samples += Sample(timeS, x, y, vx, vy)
      nextSightS = timeS + 0.1

  def x: Double  = vehicle.x
  def y: Double  = vehicle.y
  def z: Double  = vehicle.z
  def vx: Double = vehicle.vx
  def vy: Double = vehicle.vy
