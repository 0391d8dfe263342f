package skein.forecast

import skein.signal.Kinematics
import skein.units.*

/** The estimated state of a vehicle.
  *
  * @param predictedFor the time of the estimate, on the simulator's clock
  * @param readAt the time of the reading on which it is based, on the simulator's clock
  * @param state components of the plant's state, if kinematics describe only a part of it
  */
final case class Estimate(
    kinematics: Kinematics,
    predictedFor: Instant,
    readAt: Instant,
    state: Vector[Double] = Vector.empty
):

  def age: Span = predictedFor.since(readAt)
