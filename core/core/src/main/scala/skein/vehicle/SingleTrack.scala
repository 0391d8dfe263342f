package skein.vehicle

import skein.vehicle.Airframe.Gravity

/** The motion of a car by the single-track ("bicycle") model, which merges the two wheels of an axle, with
  * tyres that lag.
  *
  * The side force of a tyre is proportional to its deflection angle, up to the limit of friction. While the
  * tyre rolls, that angle follows the slip angle, the direction of the tyre's motion over the ground, with a
  * first-order lag over its relaxation length σ, σ · α' = −(velocity across the wheel) − |v| · α (Pacejka,
  * ''Tyre and Vehicle Dynamics'', 2nd ed., section 1.2 and chapter 7). The two forces turn the car and move
  * it sideways as in the linear single-track model (Rajamani, ''Vehicle Dynamics and Control'', 2nd ed.,
  * equations 2.31 and 2.32), here with the sines and cosines of the steering angle. Stiffness is proportional
  * to an axle's load, F = μ · C_S · F_z · α.
  *
  * Its acceleration is limited by the grip of the two driven wheels and by the engine's power. It is slowed
  * by the brakes, limited by the grip of all four wheels, by rolling resistance, by the air and by the
  * steered wheels. Not modelled are the reduced side force of a braking tyre, springs, and changes of the
  * axles' loads.
  *
  * Defaults are those of a BMW 320i, the second vehicle of CommonRoad (Althoff, Koschi, Manzinger,
  * ''CommonRoad: Composable Benchmarks for Motion Planning on Roads'', IV 2017; vehicle models, parameter set
  * 2): 1093.3 kg, 1791.6 kg·m², μ 1.0489, C_S 20.89 /rad, steered at 0.4 rad/s; power from 11.5 m/s² up to
  * 7.319 m/s. From other sources: full lock, 40° as in AirSim's car (`CarWheelFront`); the relaxation length,
  * 0.5 m, within the 0.3 to 0.6 m of passenger cars' tyres; the rolling resistance of 0.015 of the weight,
  * and the air's, 0.5 · 1.2 kg/m³ · 0.6 m² / m.
  *
  * A pure formula, which the simulator, predictions and SIMD forward simulation share. `SingleTrackSuite`
  * compares it with its sources.
  *
  * @param rearM distance from the rear axle to the centre of mass
  * @param gyrationM radius of gyration about the vertical axis: the root of moment of inertia over mass
  * @param relaxationM distance over which tyres respond
  * @param wattPerKg power of the engine divided by the car's mass
  */
final case class SingleTrack(
    wheelbaseM: Double = 2.5789,
    rearM: Double = 1.4227,
    gyrationM: Double = 1.2801,
    friction: Double = 1.0489,
    stiffnessPerRad: Double = 20.89,
    relaxationM: Double = 0.5,
    mostSteeredRad: Double = math.Pi * 40 / 180,
    mostSteeringRadPerS: Double = 0.4,
    wattPerKg: Double = 11.5 * 7.319,
    rolling: Double = 0.015,
    airPerM: Double = 0.00033
):
  /** Distance from the centre of mass to the front axle. */
  def frontM: Double = wheelbaseM - rearM

  /** Maximum deceleration by the brakes, m/s². */
  def brakeMps2: Double = friction * Gravity

  /** Acceleration at full throttle, m/s². */
  def driveMps2(frontMps: Double): Double =
    (friction * Gravity / 2).min(wattPerKg / math.abs(frontMps).max(1.0))

  /** Deceleration without any control, m/s². */
  def coastMps2(frontMps: Double): Double = rolling * Gravity + airPerM * frontMps * frontMps

  /** The state after `dtS` under constant controls. Steps of up to 20 ms are stable. */
  def step(state: CarState, controls: CarControls, dtS: Double): CarState =
    val most       = mostSteeringRadPerS * dtS
    val wanted     = mostSteeredRad * controls.steering.max(-1.0).min(1.0)
    val steered    = state.steeredRad + (wanted - state.steeredRad).max(-most).min(most)
    val (cos, sin) = (StrictMath.cos(steered), StrictMath.sin(steered))

    // A tyre that hardly rolls would oscillate for a long time.
    val rollsMps  = math.abs(state.frontMps).max(SingleTrack.DampedMps)
    val left      = StrictMath.exp(-rollsMps * dtS / relaxationM)
    val frontWay  = ((state.rightMps + frontM * state.yawRadPerS) * cos - state.frontMps * sin) / rollsMps
    val rearWay   = (state.rightMps - rearM * state.yawRadPerS) / rollsMps
    val frontSlip = (state.frontSlipRad + frontWay) * left - frontWay
    val rearSlip  = (state.rearSlipRad + rearWay) * left - rearWay

    // Forces divided by the mass. The load of each axle follows from its distance to the centre of mass.
    val held      = friction * Gravity / wheelbaseM
    val frontMps2 = held * rearM * (stiffnessPerRad * frontSlip).max(-1.0).min(1.0)
    val rearMps2  = held * frontM * (stiffnessPerRad * rearSlip).max(-1.0).min(1.0)
    val across    = frontMps2 * cos
    val right     = state.rightMps + dtS * (across + rearMps2 - state.frontMps * state.yawRadPerS)
    val yaw       = state.yawRadPerS + dtS * (frontM * across - rearM * rearMps2) / (gyrationM * gyrationM)
    val throttle  = controls.throttle.max(-1.0).min(1.0) * driveMps2(state.frontMps)
    val driven    = state.frontMps + dtS * (throttle - frontMps2 * sin + state.rightMps * state.yawRadPerS)
    val brake     = controls.brake.max(0.0).min(1.0) * brakeMps2
    val slowed    = dtS * (brake + coastMps2(state.frontMps))
    val front     = driven - driven.max(-slowed).min(slowed)
    val halfS     = dtS / 2
    val turn      = halfS * (state.yawRadPerS + yaw)
    val along     = state.headingRad + turn / 2
    val (alongM, acrossM) = (halfS * (state.frontMps + front), halfS * (state.rightMps + right))
    CarState(
      state.northM + alongM * StrictMath.cos(along) - acrossM * StrictMath.sin(along),
      state.eastM + alongM * StrictMath.sin(along) + acrossM * StrictMath.cos(along),
      state.headingRad + turn,
      front,
      right,
      yaw,
      frontSlip,
      rearSlip,
      steered
    )

object SingleTrack:
  /** Speed below which tyres respond as at this speed, m/s: so slow a car hardly needs side forces. */
  private val DampedMps = 5.0
