package skein.forward

import skein.forecast.{Forecast, Leg}
import skein.fusion.Exposure

/** What a decision rests on, by vehicle. */
private[skein] trait Grounds:
  /** The number of its reading, which is that of its question. */
  def reading: Array[Int]

  /** When that was made, ns. */
  def validAtNs: Array[Long]

  /** Which of the decisions for it was sent last; they count from 1, the heading at the start is 0. */
  def sentDecision: Array[Int]

  /** What the readings are replaced by. */
  def forecast: Option[Forecast]

/** Is told what a loop does. */
trait LoopObserver:
  /** A vehicle was read: at this time, here (north and east, m), as the answer tells it. */
  def read(vehicle: Int, number: Int, atNs: Long, x: Double, y: Double): Unit = ()

  /** A vehicle is here (north and east, m) when the world is scored, once a period. */
  def scored(timeS: Double, vehicle: Int, x: Double, y: Double): Unit = ()

  /** It was decided for a vehicle, for the first time or so long after the decision before. */
  private[skein] def decided(vehicle: Int, atNs: Long, elapsedS: Double, upon: Grounds): Unit = ()

  /** Under `Predictive`: a reading entered the forecast.
    *
    * @param atNs now
    * @param validAtNs when it was made
    * @param legs what the vehicle flew through since the reading before, by what is known now; empty at its
    *   first
    */
  private[skein] def entered(
      vehicle: Int,
      question: Int,
      atNs: Long,
      validAtNs: Long,
      legs: => Vector[Leg]
  ): Unit = ()

  /** A command was sent: the newest decision for the vehicle. */
  def commanded(vehicle: Int, number: Int, atNs: Long, headingRad: Double, speedMps: Double): Unit = ()

  /** A command has reached the vehicle and taken the place of the one before; it acts after the vehicle's
    * dead time.
    */
  def acts(vehicle: Int, number: Int, atNs: Long): Unit = ()

  /** Who sees takes an image now. */
  private[skein] def exposed(vehicle: Int, number: Int, atNs: Long, image: Exposure): Unit = ()

  /** What an image showed is known now. */
  private[skein] def recognised(vehicle: Int, image: Int, atNs: Long): Unit = ()

object LoopObserver:
  val Nobody: LoopObserver = new LoopObserver {}
