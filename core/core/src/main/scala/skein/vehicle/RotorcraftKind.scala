package skein.vehicle

import skein.units.Span

/** The kind of multirotor that a simulator simulates.
  *
  * @param stepS duration of a step, s
  * @param make creates an instance for one vehicle
  */
final class RotorcraftKind(val stepS: Double, val make: () => Rotorcraft)

object RotorcraftKind:
  /** AirSim's quadrotor; all vehicles share one instance. */
  val AirSim: RotorcraftKind = of(Quadrotor.AirSim)

  /** [[AirSim]] with steps of this length. */
  def at(step: Span): RotorcraftKind = of(Quadrotor(stepS = step.toSeconds))

  private def of(quadrotor: Quadrotor) = RotorcraftKind(quadrotor.stepS, () => quadrotor)
