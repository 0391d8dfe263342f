package skein.forward

import skein.forecast.{Forecast, Leg}
import skein.fusion.Exposure
import skein.policy.Action

/** The data on which a decision is based; arrays are indexed by vehicle. */
private[skein] trait Grounds:
  /** Number of each vehicle's reading, which is the number of the request for it. */
  def reading: Array[Int]

  def validAtNs: Array[Long]

  /** Number of the last decision sent to each vehicle, from 1; 0 stands for the heading at the start. */
  def sentDecision: Array[Int]

  def forecast: Option[Forecast]

/** Receives the events of a simulated loop; every method does nothing by default. */
trait LoopObserver:
  /** Called when a vehicle is read; position north, east and down, m, as in the answer. */
  def read(vehicle: Int, number: Int, atNs: Long, x: Double, y: Double, z: Double): Unit = ()

  /** Called when the world is scored, once a period; a vehicle's position north, east and down, m. */
  def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit = ()

  /** Called at a decision for a vehicle.
    *
    * @param elapsedS time since its previous decision; 0 at the first
    */
  private[skein] def decided(vehicle: Int, atNs: Long, elapsedS: Double, upon: Grounds): Unit = ()

  /** Called under `Predictive` when a reading is added to the forecast.
    *
    * @param atNs the present time
    * @param validAtNs the time at which the vehicle was sampled
    * @param legs the vehicle's legs since the previous reading, as known now; empty at the first reading
    */
  private[skein] def entered(
      vehicle: Int,
      question: Int,
      atNs: Long,
      validAtNs: Long,
      legs: => Vector[Leg]
  ): Unit = ()

  /** Called when a command is sent, which is the newest decision for the vehicle. */
  def commanded(vehicle: Int, number: Int, atNs: Long, action: Action): Unit = ()

  /** Called when a command reaches the vehicle and replaces the previous one; it takes effect after the
    * vehicle's dead time.
    */
  def acts(vehicle: Int, number: Int, atNs: Long): Unit = ()

  private[skein] def exposed(vehicle: Int, number: Int, atNs: Long, image: Exposure): Unit = ()

  private[skein] def recognised(vehicle: Int, image: Int, atNs: Long): Unit = ()

object LoopObserver:
  val Nobody: LoopObserver = new LoopObserver {}
