package skein.vehicle

/** A few-parameter model of how horizontal velocity v follows a commanded velocity u that stands still
  * between events:
  *
  *   - along u: v' = (gain · |u| − v) / lag − drag · s · v
  *   - across u: v' = −v / turnLag − drag · s · v
  *
  * A command takes effect `deadTimeS` after its arrival. s is the speed when the present piece of the flight
  * began: pieces begin when a command takes effect, and every [[ReducedModel.PieceS]] after it. So each piece
  * is linear and has a closed form, and drag still grows with the square of the speed. Without drag a piece
  * is exact however long it is.
  *
  * Why this form: AirSim's flight controller tilts in proportion to the velocity's error, so velocity has a
  * first-order lag (the tilt itself settles within a dead time); the air's drag is quadratic, so a gain fits
  * one speed only.
  *
  * @param gain reached over commanded speed, drag apart
  * @param lagS of the velocity along the command, s
  * @param deadTimeS from a command's arrival until it acts
  * @param turnLagS of the velocity across the command, s: how fast the old direction dies away
  * @param dragPerM deceleration per squared speed, 1/m
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

  private val drags       = dragPerM != 0
  private val turns       = turnLagS != lagS
  private val turnsSlowly = turnLagS > lagS
  private val slowLagS    = lagS.max(turnLagS)
  private val fasterPerS  = (1 / lagS - 1 / turnLagS).abs

  def initial: PlaneReading                                            = PlaneReading(0, 0, 0, 0)
  def read(state: PlaneReading): PlaneReading                          = state
  def corrected(state: PlaneReading, seen: PlaneReading): PlaneReading = seen
  def stepS: Double = if drags then ReducedModel.PieceS else ReducedModel.LongestPieceS

  def isLag: Boolean = !drags && !turns

  /** The state at a time after the start of a piece. */
  def step(from: PlaneReading, wantedVx: Double, wantedVy: Double, spanS: Double): PlaneReading =
    import from.{eastMps as vy, northMps as vx}
    val drag             = if drags then dragPerM * math.sqrt(vx * vx + vy * vy) else 0
    val perRate          = 1 / (1 / lagS + drag)
    val slowLeft         = StrictMath.exp(-(1 / slowLagS + drag) * spanS)
    val left             = if turnsSlowly then slowLeft * fasterLeft(spanS) else slowLeft
    val carriesS         = (1 - left) * perRate
    val reached          = gain / lagS * perRate
    val (goalVx, goalVy) = (wantedVx * reached, wantedVy * reached)
    val (offVx, offVy)   = (vx - goalVx, vy - goalVy)
    val alike            = PlaneReading(
      from.northM + goalVx * spanS + offVx * carriesS,
      from.eastM + goalVy * spanS + offVy * carriesS,
      goalVx + offVx * left,
      goalVy + offVy * left
    )
    if turns then
      val crossLeft    = if turnsSlowly then slowLeft else slowLeft * fasterLeft(spanS)
      val carryAcrossS = (1 - crossLeft) * (1 / (1 / turnLagS + drag))
      across(alike, wantedVx, wantedVy, offVx, offVy, crossLeft - left, carryAcrossS - carriesS)
    else alike

  /** Integral of what remains of an error with the slower decay: drag reduces both components equally. */
  private def fasterLeft(spanS: Double) = StrictMath.exp(-fasterPerS * spanS)

  /** The part of the velocity's error across the command decays at its own rate. If the command is to stand
    * still, the whole error decays with the lag along.
    *
    * @param leftMore by how much more of that part remains than of the rest, and for how much longer it
    *   carries, s
    */
  private def across(
      alike: PlaneReading,
      wantedVx: Double,
      wantedVy: Double,
      offVx: Double,
      offVy: Double,
      leftMore: Double,
      carryMoreS: Double
  ): PlaneReading =
    val square  = wantedVx * wantedVx + wantedVy * wantedVy
    val share   = (offVx * wantedVx + offVy * wantedVy) / square
    val crossVx = if square > 0 then offVx - share * wantedVx else 0
    val crossVy = if square > 0 then offVy - share * wantedVy else 0
    PlaneReading(
      alike.northM + crossVx * carryMoreS,
      alike.eastM + crossVy * carryMoreS,
      alike.northMps + crossVx * leftMore,
      alike.eastMps + crossVy * leftMore
    )

object ReducedModel:
  /** Longest piece with a constant value of the drag, s. */
  val PieceS = 0.1

  /** Longest piece of a model without drag, s. */
  val LongestPieceS = 1.0

  /** A plain first-order lag with dead time, without drag. */
  def lag(gain: Double, lagS: Double, deadTimeS: Double): ReducedModel =
    ReducedModel(gain, lagS, deadTimeS, lagS, 0)

  /** AirSim's default quadrotor under `moveByVelocityZ` at z = −20 m without drag, as `./skein identify` fits
    * it to live flights of the paper's duel: gain ± 0.017, lag ± 0.07 s, dead time ± 0.02 s (95 %). Off the
    * full quadrotor by 0.02 m after 1 s and 0.22 m after 5 s (medians). [[AirSim]] follows it more closely.
    */
  val AirSimLag: ReducedModel = lag(gain = 0.919, lagS = 2.66, deadTimeS = 0.053)

  /** AirSim's default quadrotor under `moveByVelocityZ` at z = −20 m. The lag depends on the altitude, since
    * AirSim's controller mistakes the altitude's goal for a velocity once the vehicle tilts
    * ([[FlightController]]).
    *
    * Source: `./skein identify` on live flights of the paper's duel by four loops over two links, 14 × 60 s:
    * gain ± 0.023, lag ± 0.09 s, dead time ± 0.018 s, drag ± 0.0004 /m (95 %). The airframe's own drag is
    * 0.0065 /m. Off the full quadrotor by 0.007 m after 1 s, 0.02 m after 2 s and 0.05 m after 5 s (medians;
    * 95 %: 0.06, 0.13 and 0.43 m).
    */
  val AirSim: ReducedModel = ReducedModel(1.02, 2.967, 0.037, 2.967, 0.0067)

  /** [[AirSim]] at another altitude goal. The controller tilts by k · (error of velocity − tilt · |z|) with k =
    * 0.2 · π/5.5, its gain and limit of the tilt ([[FlightController]]), which accelerates by g · tilt: so
    * the lag is (1 + k · |z|) / (k · g), 1.40 s at 5 m and 2.93 s at 20 m, where [[AirSim]] was identified
    * and is kept.
    */
  def airSimAt(altitudeM: Double): ReducedModel =
    if math.abs(altitudeM) == IdentifiedAtM then AirSim
    else
      val k   = 0.2 * math.Pi / 5.5
      val lag = (1 + k * math.abs(altitudeM)) / (k * 9.80665)
      AirSim.copy(lagS = lag, turnLagS = lag)

  /** The altitude of the flights that [[AirSim]] was identified from, m. */
  val IdentifiedAtM = 20.0
