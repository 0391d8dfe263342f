package skein.forecast

import skein.signal.Kinematics
import skein.units.*

/** The estimated state of a vehicle.
  *
  * @param predictedFor the simulator's time for which the estimate holds
  * @param readAt the simulator's time of the reading from which it was predicted
  * @param state of its plant, as numbers, where kinematics do not describe the whole state
  */
final case class Estimate(
    kinematics: Kinematics,
    predictedFor: Instant,
    readAt: Instant,
    state: Vector[Double] = Vector.empty
):

  /** Time from the reading to the predicted moment. */
  def age: Span = predictedFor.since(readAt)
