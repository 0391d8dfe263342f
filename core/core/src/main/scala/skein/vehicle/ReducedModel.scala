package skein.vehicle

/** A model with few parameters for a horizontal velocity v that follows a commanded velocity u, which is
  * constant between events:
  *
  *   - along u: v' = (gain · |u| − v) / lag − drag · s · v
  *   - across u: v' = −v / turnLag − drag · s · v
  *
  * A command takes effect `deadTimeS` after its arrival. s is the speed at the start of the present piece of
  * the flight. A piece begins when a command takes effect, and every [[ReducedModel.PieceS]] after that. So
  * each piece is linear and has a closed form, while drag still increases with the square of the speed.
  * Without drag, pieces of any length are exact.
  *
  * The reason for this form: AirSim's flight controller tilts in proportion to the velocity's error, so
  * velocity has a first-order lag (the tilt itself settles within a dead time); the air's drag is quadratic,
  * so that a gain alone would fit only one speed.
  *
  * @param gain final speed divided by commanded speed, without drag
  * @param lagS lag of the velocity along the command, s
  * @param deadTimeS time from a command's arrival until it takes effect, s
  * @param turnLagS lag of the velocity across the command, s, with which the old direction decays
  * @param dragPerM deceleration per squared speed, 1/m
  */
final case class ReducedModel(
    gain: Double,
    lagS: Double,
    override val deadTimeS: Double,
    turnLagS: Double,
    dragPerM: Double
) extends ObservedPlant[PlaneReading]:
  require(lagS > 0 && turnLagS > 0, s"both lags must be positive, got $lagS s and $turnLagS s")
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

  /** The state `spanS` after the start of a piece. */
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

  /** The factor by which the faster decaying part of an error is smaller than the slower one. Drag affects
    * both equally.
    */
  private def fasterLeft(spanS: Double) = StrictMath.exp(-fasterPerS * spanS)

  /** Corrects the part of the velocity error that is across the command and decays at its own rate. If the
    * command is to stand still, the whole error decays with the lag along.
    *
    * @param leftMore difference between the remaining shares, across less along; `carryMoreS` likewise for
    *   the times, s, for which the errors carry the vehicle
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
  /** Duration of a piece with constant drag, s. */
  val PieceS = 0.1

  /** Maximum duration of a piece without drag, s. */
  val LongestPieceS = 1.0

  /** A first-order lag with dead time and without drag. */
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

  /** [[AirSim]] at another altitude goal. The controller tilts by k · (error of velocity − tilt · |z|) with k
    * = 0.2 · π/5.5, its gain and limit of the tilt ([[FlightController]]), and accelerates by g · tilt. So
    * the lag is (1 + k · |z|) / (k · g), 1.40 s at 5 m and 2.93 s at 20 m, the altitude at which [[AirSim]]
    * was identified; there the result is [[AirSim]] itself.
    */
  def airSimAt(altitudeM: Double): ReducedModel =
    if math.abs(altitudeM) == IdentifiedAtM then AirSim
    else
      val k   = 0.2 * math.Pi / 5.5
      val lag = (1 + k * math.abs(altitudeM)) / (k * 9.80665)
      AirSim.copy(lagS = lag, turnLagS = lag)

  /** Altitude of the flights from which [[AirSim]] was identified, m. */
  val IdentifiedAtM = 20.0
