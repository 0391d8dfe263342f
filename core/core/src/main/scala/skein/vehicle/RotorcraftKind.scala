package skein.vehicle

import skein.units.Span

/** What a simulator's multirotors are.
  *
  * @param stepS of every one of them, s
  * @param make makes one, for one vehicle
  */
final class RotorcraftKind(val stepS: Double, val make: () => Rotorcraft)

object RotorcraftKind:
  /** AirSim's quadrotor, which serves any number of vehicles. */
  val AirSim: RotorcraftKind = of(Quadrotor.AirSim)

  /** The same in steps of this length. */
  def at(step: Span): RotorcraftKind = of(Quadrotor(stepS = step.toSeconds))

  private def of(quadrotor: Quadrotor) = RotorcraftKind(quadrotor.stepS, () => quadrotor)
