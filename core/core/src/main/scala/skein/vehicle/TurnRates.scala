package skein.vehicle

/** An estimate of the rate at which a heading turns: probabilities of [[TurnRates.Each]], by Bayes' rule. A
  * rate is assumed to be held for a while; then another is taken, more likely one that was seen before.
  * Immutable.
  *
  * At a constant rate the heading is a line in time; measured headings deviate from it, since commands are
  * steps. For each rate a Kalman filter estimates the heading, and is mixed with the filters of the other
  * rates, since the rate may have changed: the interacting multiple models of Blom and Bar-Shalom, IEEE
  * Transactions on Automatic Control 33(8), 1988. The size of the deviations is learned.
  *
  * @param shares probabilities of the rates; they add up to 1
  * @param headings estimated heading for each rate, rad; likewise `variances`, rad²
  * @param offRad2 mean square of a measured heading's deviation from its line, rad²
  * @param spentS time for which each rate was seen, s, with fading memory
  */
final case class TurnRates private (
    shares: Vector[Double],
    headings: Vector[Double],
    variances: Vector[Double],
    offRad2: Double,
    spentS: Vector[Double]
):
  import TurnRates.*

  /** The mean of the rates by their probabilities, rad/s. */
  def mean: Double = shares.lazyZip(Each).map(_ * _).sum

  /** The probabilities of the rates that may be used next. */
  def next: Vector[Double] = normalised(spentS)

  /** The prediction after `s` seconds: rates may have changed, and headings have turned. */
  def after(s: Double): TurnRates =
    val changed = 1 - StrictMath.exp(-s / HoldsS)
    val middle  = headings(shares.indexOf(shares.max))
    val offs    = headings.map(heading => wrapped(heading - middle))
    val common  = shares.lazyZip(offs).map(_ * _).sum
    val spread  = shares.lazyZip(offs).lazyZip(variances).map((share, off, variance) =>
      share * (variance + (off - common) * (off - common))
    ).sum
    val come  = next.map(_ * changed)
    val stay  = shares.map(_ * (1 - changed))
    val mixed = Each.indices.toVector.map: k =>
      val fresh = come(k) / (come(k) + stay(k))
      val apart = common - offs(k)
      (
        heading = middle + offs(k) + fresh * apart + Each(k) * s,
        variance =
          (1 - fresh) * variances(k) + fresh * (spread + (1 - fresh) * apart * apart) + DriftRad2PerS * s
      )
    copy(come.lazyZip(stay).map(_ + _), mixed.map(_.heading), mixed.map(_.variance))

  /** The prediction after `s` seconds, updated by the likelihood of the heading measured then, rad. */
  def after(s: Double, heading: Double): TurnRates =
    val ahead   = after(s)
    val off     = ahead.headings.map(at => wrapped(heading - at))
    val spreads = ahead.variances.map(_ + offRad2)
    val found   = normalised(Each.indices.toVector.map: k =>
      ahead.shares(
        k
      ) * (Floor + StrictMath.exp(-0.5 * off(k) * off(k) / spreads(k)) / StrictMath.sqrt(spreads(k))))
    val gains      = ahead.variances.lazyZip(spreads).map(_ / _)
    val fades      = StrictMath.exp(-s / RemembersS)
    val meanSquare = found.lazyZip(off).map((share, off) => share * off * off).sum
    TurnRates(
      found,
      ahead.headings.lazyZip(gains).lazyZip(off).map(_ + _ * _),
      ahead.variances.lazyZip(gains).map((variance, gain) => variance * (1 - gain)),
      (offRad2 + (meanSquare.min(4 * offRad2) - offRad2) * (s / LearnsS).min(1)).max(LeastRad2).min(MostRad2),
      spentS.lazyZip(found).map((spent, share) =>
        spent * fades + share * s + PriorS / Each.size * (1 - fades)
      )
    )

object TurnRates:
  /** Turn rates that a vehicle may be commanded, rad/s. */
  val Each: Vector[Double] = Vector.tabulate(17)(number => 0.2 * (number - 8))

  /** Mean time until a rate is drawn again, s; if few rates are usual, the draw often repeats the present
    * one.
    */
  val HoldsS: Double = 0.8

  /** Weight of the uniform prior of the next rate, as a time, s; and the time constant of the memory of
    * rates, s.
    */
  private val PriorS     = 1.0
  private val RemembersS = 60.0

  private val LearnsS       = 2.0
  private val LeastRad2     = 0.03 * 0.03
  private val MostRad2      = 0.3 * 0.3
  private val DriftRad2PerS = 0.01
  private val Floor         = 1e-3

  /** The estimate for a vehicle of which only the heading, rad, is known. */
  def of(heading: Double): TurnRates =
    val even = Each.map(_ => 1.0 / Each.size)
    TurnRates(even, Each.map(_ => heading), Each.map(_ => 1.0), 0.05 * 0.05, even.map(_ * PriorS))

  private def normalised(weights: Vector[Double]) =
    val all = weights.sum
    weights.map(_ / all)

  private def wrapped(angle: Double) = angle - 2 * math.Pi * math.rint(angle / (2 * math.Pi))
