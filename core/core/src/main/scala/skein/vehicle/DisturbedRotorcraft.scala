package skein.vehicle

import skein.units.Vector3

/** A multirotor in wind, with rotors that are weaker than its controller assumes.
  *
  * @param rotors share of its control that each rotor performs, 0 to 1, in [[Airframe]]'s order
  */
final class DisturbedRotorcraft(of: Rotorcraft, wind: WindAlong, rotors: Vector[Double]) extends Rotorcraft:
  private val areWhole = rotors.forall(_ == 1)

  export of.{airframe, cascade, gains, hover, hoverSagM, land, stepS}

  def tuned(cascade: CascadeGains): Rotorcraft = DisturbedRotorcraft(of.tuned(cascade), wind, rotors)

  /** Advances `state` by one step; this vehicle's wind is added to the environment's. */
  def step(state: QuadrotorState, setpoint: Setpoint, environment: Environment): Unit =
    if !areWhole then
      state.control0 *= rotors(0)
      state.control1 *= rotors(1)
      state.control2 *= rotors(2)
      state.control3 *= rotors(3)
    val velocity = Vector3(state.vx, state.vy, state.vz)
    val met      = wind.met(environment.groundDownM - state.z, velocity, stepS)
    of.step(state, setpoint, environment.copy(windNed = environment.windNed + met))
