package skein.planning

/** A sequence of actions, each for one step: turn rate, rad/s, and commanded speed, m/s. */
final case class Manoeuvre(turnRates: IArray[Float], speeds: IArray[Float]):
  require(turnRates.length == speeds.length, "a turn rate and a speed per step")

  def steps: Int = turnRates.length

  /** The remainder of the manoeuvre after some time, extended by its last action. Actions are interpolated
    * between steps.
    */
  def shifted(elapsedS: Double, dtS: Double): Manoeuvre =
    Manoeuvre(Manoeuvre.shifted(turnRates, elapsedS / dtS), Manoeuvre.shifted(speeds, elapsedS / dtS))

object Manoeuvre:
  def straight(speed: Double, steps: Int): Manoeuvre = steady(0, speed, steps)

  def steady(turnRate: Double, speed: Double, steps: Int): Manoeuvre =
    Manoeuvre(IArray.fill(steps)(turnRate.toFloat), IArray.fill(steps)(speed.toFloat))

  private[planning] def shifted(values: IArray[Float], by: Double): IArray[Float] =
    val last  = values.length - 1
    val whole = math.min(last.toDouble, math.floor(by)).toInt
    val part  = math.min(1.0, by - whole).toFloat
    IArray.tabulate(values.length): step =>
      val (here, next) = (values(math.min(last, step + whole)), values(math.min(last, step + whole + 1)))
      here + (next - here) * part
