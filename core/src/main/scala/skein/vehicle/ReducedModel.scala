package skein.vehicle

/** A few-parameter model of how horizontal velocity v follows a commanded velocity u that stands still between events:
  *
  *   - along u: v' = (gain · |u| − v) / lag − drag · s · v
  *   - across u: v' = −v / turnLag − drag · s · v
  *
  * A command acts `deadTimeS` after it has come. s is the speed when the present piece of the flight began: pieces begin
  * when a command begins to act, and every [[ReducedModel.PieceS]] after it. So each piece is linear and has a closed
  * form, and drag still grows with the square of the speed.
  *
  * Why this form: AirSim's flight controller tilts in proportion to the velocity's error, so velocity has a first-order
  * lag (the tilt itself settles within a dead time); the air's drag is quadratic, so a gain fits one speed only.
  *
  * @param gain
  *   reached over commanded speed, drag apart
  * @param lagS
  *   of the velocity along the command, s
  * @param deadTimeS
  *   from a command's arrival until it acts
  * @param turnLagS
  *   of the velocity across the command, s: how fast the old direction dies away
  * @param dragPerM
  *   deceleration per squared speed, 1/m
  */
final case class ReducedModel(
    gain: Double,
    lagS: Double,
    override val deadTimeS: Double,
    turnLagS: Double,
    dragPerM: Double
) extends ObservedPlant[PlaneReading]:
  require(lagS > 0 && turnLagS > 0, s"both lags must be positive, came $lagS s and $turnLagS s")
  require(deadTimeS >= 0 && dragPerM >= 0, s"negative: dead time $deadTimeS s or drag $dragPerM /m")

  private val turns = turnLagS != lagS

  def initial: PlaneReading                                            = PlaneReading(0, 0, 0, 0)
  def read(state: PlaneReading): PlaneReading                          = state
  def corrected(state: PlaneReading, seen: PlaneReading): PlaneReading = seen
  def stepS: Double                                                    = ReducedModel.PieceS

  /** Within a piece of the flight, from its begin. */
  def step(from: PlaneReading, wantedVx: Double, wantedVy: Double, spanS: Double): PlaneReading =
    import from.{eastMps as vy, northMps as vx}
    val wanted = math.sqrt(wantedVx * wantedVx + wantedVy * wantedVy)
    val speed  = math.sqrt(vx * vx + vy * vy)
    // Told to stand still, all velocity dies away with the lag along.
    val alongX             = if wanted > 0 then wantedVx / wanted else if speed > 0 then vx / speed else 1.0
    val alongY             = if wanted > 0 then wantedVy / wanted else if speed > 0 then vy / speed else 0.0
    val drag               = dragPerM * speed
    val rateAlong          = 1 / lagS + drag
    val rateCross          = 1 / turnLagS + drag
    val goal               = gain * wanted / (lagS * rateAlong)
    val along              = vx * alongX + vy * alongY
    val excess             = along - goal
    val (crossVx, crossVy) = (vx - along * alongX, vy - along * alongY)
    val leftAlong          = StrictMath.exp(-rateAlong * spanS)
    val leftCross          = if turns then StrictMath.exp(-rateCross * spanS) else leftAlong
    val movedAlong         = goal * spanS + excess * (1 - leftAlong) / rateAlong
    val movedCross         = (1 - leftCross) / rateCross
    val reached            = goal + excess * leftAlong
    PlaneReading(
      from.northM + alongX * movedAlong + crossVx * movedCross,
      from.eastM + alongY * movedAlong + crossVy * movedCross,
      alongX * reached + crossVx * leftCross,
      alongY * reached + crossVy * leftCross
    )

object ReducedModel:
  /** The longest flight under one value of the drag, s. */
  val PieceS = 0.1

  /** A plain first-order lag. */
  def lag(gain: Double, lagS: Double, deadTimeS: Double): ReducedModel =
    ReducedModel(gain, lagS, deadTimeS, lagS, 0)

  /** AirSim's default quadrotor under `moveByVelocityZ` at z = −20 m. The lag depends on the altitude, since AirSim's
    * controller mistakes the altitude's goal for a velocity once the vehicle tilts ([[FlightController]]).
    *
    * Source: `./skein identify` on live flights of the paper's duel by four loops over two links, 14 × 60 s: gain ± 0.023,
    * lag ± 0.09 s, dead time ± 0.018 s, drag ± 0.0004 /m (95 %). The airframe's own drag is 0.0065 /m. Off the full
    * quadrotor by 0.007 m after 1 s, 0.02 m after 2 s and 0.05 m after 5 s (medians; 95 %: 0.06, 0.13 and 0.43 m).
    */
  val AirSim: ReducedModel = ReducedModel(1.02, 2.967, 0.037, 2.967, 0.0067)

  /** [[AirSim]] at another altitude goal. The controller tilts by k · (error of velocity − tilt · |z|) with
    * k = 0.2 · π/5.5, its gain and limit of the tilt ([[FlightController]]), which accelerates by g · tilt: so the lag is
    * (1 + k · |z|) / (k · g), 1.40 s at 5 m and 2.93 s at 20 m, where [[AirSim]] was identified and is kept.
    */
  def airSimAt(altitudeM: Double): ReducedModel =
    if math.abs(altitudeM) == IdentifiedAtM then AirSim
    else
      val k   = 0.2 * math.Pi / 5.5
      val lag = (1 + k * math.abs(altitudeM)) / (k * 9.80665)
      AirSim.copy(lagS = lag, turnLagS = lag)

  /** The altitude of the flights that [[AirSim]] was identified from, m. */
  val IdentifiedAtM = 20.0
