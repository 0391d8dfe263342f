package skein.vehicle

import skein.signal.SplitMix64
import skein.units.Vector3

/** The wind at a place: a steady part, which may increase with height, and gusts.
  *
  * @param steadyNed velocity of the air, m/s; with shear, at a height of 20 ft
  * @param gustsMps wind speed at 20 ft that determines the gusts, m/s: 7.7 light, 15.4 moderate, 23.2 severe
  *   turbulence (15, 30 and 45 kn)
  * @param roughnessM roughness length of the ground, m; the steady part is then proportional to ln(height /
  *   roughness). 0 disables shear
  */
final case class Wind(steadyNed: Vector3 = Vector3.Zero, gustsMps: Double = 0, roughnessM: Double = 0):

  /** The steady part at a height above the ground, m. */
  def steadyAt(heightM: Double): Vector3 =
    if roughnessM == 0 then steadyNed
    else if heightM <= roughnessM then Vector3.Zero
    else steadyNed * (StrictMath.log(heightM / roughnessM) / StrictMath.log(Wind.ReferenceM / roughnessM))

object Wind:
  val None: Wind = Wind()

  /** 20 ft, the height of the wind speed by which turbulence is classified. */
  val ReferenceM: Double = 20 * FootM

  private[vehicle] inline val FootM = 0.3048

/** The wind that one vehicle meets along its path. Mutable: contains the gusts' state. Equal seeds and
  * flights give equal bits.
  *
  * Gusts have the intensities and scale lengths of the Dryden model at low altitude (MIL-F-8785C, section
  * 3.7.3, with h in feet, from 10 to 1000): σ,,w,, = 0.1 W20, L,,w,, = h; σ,,u,, = σ,,v,, = σ,,w,, / (0.177 +
  * 0.000823 h)^0.4^, L,,u,, = L,,v,, = h / (0.177 + 0.000823 h)^1.2^. Along each axis they are a first-order
  * Markov process over the distance through the air. Along the flight this is Dryden's model; across it, the
  * model's second-order spectrum is replaced by the first-order one of equal variance and length.
  */
final class WindAlong(wind: Wind, seed: Long):
  import Wind.FootM

  private val random      = SplitMix64(seed)
  private var north, east = 0.0
  private var down        = 0.0

  /** The velocity of the air, NED, m/s, after a further `dtS` of flight at this velocity.
    *
    * @param heightM height above the ground
    */
  def met(heightM: Double, velocityNed: Vector3, dtS: Double): Vector3 =
    val steady = wind.steadyAt(heightM)
    if wind.gustsMps == 0 then steady
    else
      // Otherwise a vehicle that hovers in still air would keep its gust forever.
      val flownM   = (velocityNed - steady).norm.max(WindAlong.LeastAirspeedMps) * dtS
      val h        = (heightM / FootM).max(10).min(1000)
      val growth   = 0.177 + 0.000823 * h
      val sigmaW   = 0.1 * wind.gustsMps
      val sigma    = sigmaW / StrictMath.pow(growth, 0.4)
      val lengthM  = h / StrictMath.pow(growth, 1.2) * FootM
      val lengthWM = h * FootM
      north = next(north, sigma, flownM / lengthM)
      east = next(east, sigma, flownM / lengthM)
      down = next(down, sigmaW, flownM / lengthWM)
      steady + Vector3(north, east, down)

  private def next(gust: Double, sigma: Double, lengths: Double): Double =
    GaussMarkov.next(gust, sigma, lengths, random)

object WindAlong:
  private val LeastAirspeedMps = 1.0
