package skein.vehicle

/** AirSim's quadrotor without its fastest parts: the cascade of [[FlightController]] from velocities to tilt
  * and throttle, without the lag of rotors and rotation rates, and with the nose to north. In each horizontal
  * axis
  *
  *   - the wanted tilt is k · (u − v + tilt · (third − sink rate)), at most `maxTilt`, with k = velocityP ·
  *     maxTilt: a quirk of AirSim's controller by which the third goal counts as wanted speed once the
  *     vehicle tilts;
  *   - the tilt follows the wanted tilt at the rate `angleP` · `maxRate` times the difference, at most at
  *     `maxRate`;
  *   - v' = g · throttle / hover · sin(tilt) − drag · |v| · v.
  *
  * The throttle follows the vertical controller, with its integral and its limits. Tilts are assumed small
  * enough for the first terms of sine and cosine. The error against the complete quadrotor is at most 1 % of
  * the path while climbing, sinking and turning (`TiltModelSuite`).
  *
  * @param hover throttle at which thrust balances weight
  * @param sideDragPerM deceleration per squared horizontal speed, 1/m
  * @param downDragPerM deceleration per squared speed through the rotors' discs, 1/m
  * @param deadTimeS dead time in place of the lag of rotors and rotation rates, s
  */
final case class TiltModel(
    hover: Double,
    sideDragPerM: Double,
    downDragPerM: Double,
    override val deadTimeS: Double,
    gains: ControllerGains = ControllerGains()
) extends ObservedSpatialPlant[TiltState]:
  private val tiltPerMps   = gains.velocityP * gains.maxTilt
  private val tiltPerS     = gains.angleP * gains.maxRate
  private val climbPerM    = gains.positionP * gains.maxVelocity
  private val discountPerS = (1 - gains.verticalDiscount) / TiltModel.ControlS

  def stepS: Double = 0.02

  def initial(downM: Double): TiltState = TiltState(0, 0, downM, 0, 0, 0, 0, 0, 1 - 2 * hover, 1)

  def read(state: TiltState): SpaceReading =
    import state.*
    SpaceReading(northM, eastM, northMps, eastMps, downM, downMps)

  def corrected(state: TiltState, seen: SpaceReading): TiltState = state.copy(
    northM = seen.northM,
    eastM = seen.eastM,
    downM = seen.downM,
    northMps = seen.northMps,
    eastMps = seen.eastMps,
    downMps = seen.downMps
  )

  def step(
      from: TiltState,
      northMps: Double,
      eastMps: Double,
      third: Double,
      holds: Double,
      dtS: Double
  ): TiltState =
    import from.{northMps as vn, eastMps as ve, downMps as vd}
    val tiltNorth = tilted(from.tiltNorth, northMps - vn, third - vd, dtS)
    val tiltEast  = tilted(from.tiltEast, eastMps - ve, third - vd, dtS)
    val climbs    =
      if holds > 0 then
        clip(climbPerM * (third - from.downM), gains.maxVelocity) + tiltNorth * vn + tiltEast * ve
      else third - tiltNorth * (northMps - vn) - tiltEast * (eastMps - ve)
    val error    = climbs - vd
    val before   = if holds == from.held then from.integral else 0
    val integral = clip(before + (gains.verticalI * error - discountPerS * before) * dtS, 1)
    val throttle = ((1 - clip(gains.verticalP * error + integral, 1)) / 2).max(gains.minThrottle)
    val lift     = TiltModel.Gravity * throttle / hover
    val through  = vd - tiltNorth * vn - tiltEast * ve
    val pushes   = lift + downDragPerM * through * through.abs
    val nextVn   = vn + (pushes * sine(tiltNorth) - sideDragPerM * vn * vn.abs) * dtS
    val nextVe   = ve + (pushes * sine(tiltEast) - sideDragPerM * ve * ve.abs) * dtS
    val level    = 1 - (tiltNorth * tiltNorth + tiltEast * tiltEast) / 2
    val nextVd   = vd + (TiltModel.Gravity - pushes * level) * dtS
    TiltState(
      from.northM + (vn + nextVn) / 2 * dtS,
      from.eastM + (ve + nextVe) / 2 * dtS,
      from.downM + (vd + nextVd) / 2 * dtS,
      nextVn,
      nextVe,
      nextVd,
      tiltNorth,
      tiltEast,
      integral,
      holds
    )

  /** The tilt along an axis after `dtS`, rad.
    *
    * @param errorMps wanted less present velocity along the axis
    */
  private def tilted(tilt: Double, errorMps: Double, sinkMps: Double, dtS: Double): Double =
    val wanted = clip(tiltPerMps * (errorMps + tilt * sinkMps), gains.maxTilt)
    tilt + clip(tiltPerS * (wanted - tilt), gains.maxRate) * dtS

  private def sine(tilt: Double) = tilt - tilt * tilt * tilt / 6

  private def clip(value: Double, most: Double) = value.max(-most).min(most)

/** The state of a [[TiltModel]].
  *
  * @param tiltNorth tilt along north, rad, positive if it accelerates the vehicle to north
  * @param integral integral term of the vertical velocity's controller
  * @param held 1 if the last command held an altitude, else 0
  */
final case class TiltState(
    northM: Double,
    eastM: Double,
    downM: Double,
    northMps: Double,
    eastMps: Double,
    downMps: Double,
    tiltNorth: Double,
    tiltEast: Double,
    integral: Double,
    held: Double
)

object TiltModel:
  private val Gravity  = Airframe.Gravity
  private val ControlS = 0.003

  /** The model of a quadrotor at low altitude, from its throttle at hover, its drag and its gains. */
  def of(quadrotor: Quadrotor): TiltModel =
    import quadrotor.airframe
    val kgPerM3 = Atmosphere.SeaLevelDensity
    TiltModel(
      quadrotor.hoverControl(0),
      airframe.dragFront * kgPerM3 / airframe.massKg,
      airframe.dragDown * kgPerM3 / airframe.massKg,
      RotorsS,
      quadrotor.gains
    )

  /** Dead time, s, fitted to steps of the climb rate and of the speed (`TiltModelSuite`). */
  private val RotorsS = 0.03

  val AirSim: TiltModel = of(Quadrotor.AirSim)
