package skein.forward

import skein.forecast.{Forecast, Leg}
import skein.fusion.Exposure
import skein.policy.Action

/** The data on which a decision is based, by vehicle. */
private[skein] trait Grounds:
  /** Number of each vehicle's reading, which equals that of its request. */
  def reading: Array[Int]

  def validAtNs: Array[Long]

  /** Number of the last sent decision for each vehicle, from 1; the heading at the start is 0. */
  def sentDecision: Array[Int]

  def forecast: Option[Forecast]

/** Receives the events of a simulated loop; every method does nothing by default. */
trait LoopObserver:
  /** A vehicle was read at this time; position (north, east and down, m) as in the answer. */
  def read(vehicle: Int, number: Int, atNs: Long, x: Double, y: Double, z: Double): Unit = ()

  /** A vehicle's position (north, east and down, m) when the world is scored, once a period. */
  def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit = ()

  /** A decision was made for a vehicle, the first one or some time after the previous one. */
  private[skein] def decided(vehicle: Int, atNs: Long, elapsedS: Double, upon: Grounds): Unit = ()

  /** Under `Predictive`: a reading was added to the forecast.
    *
    * @param atNs now
    * @param validAtNs when it was sampled
    * @param legs the vehicle's legs since the previous reading, by what is known now; empty at its first
    */
  private[skein] def entered(
      vehicle: Int,
      question: Int,
      atNs: Long,
      validAtNs: Long,
      legs: => Vector[Leg]
  ): Unit = ()

  /** A command was sent: the newest decision for the vehicle. */
  def commanded(vehicle: Int, number: Int, atNs: Long, action: Action): Unit = ()

  /** A command has reached the vehicle and replaced the one before; it takes effect after the vehicle's dead
    * time.
    */
  def acts(vehicle: Int, number: Int, atNs: Long): Unit = ()

  private[skein] def exposed(vehicle: Int, number: Int, atNs: Long, image: Exposure): Unit = ()

  private[skein] def recognised(vehicle: Int, image: Int, atNs: Long): Unit = ()

object LoopObserver:
  val Nobody: LoopObserver = new LoopObserver {}
