package skein.lanes.timetable

/** An event of an episode, recorded by [[TimetableNotes]]. Readings and decisions are numbered per vehicle,
  * views across all vehicles.
  */
private[lanes] sealed trait Note:
  def atS: Double

private[lanes] object Note:
  /** A vehicle's position is sampled, for a reading, a score or an image.
    *
    * @param sensedNs time of a reading that may have errors, ns; negative for the truth
    */
  final case class Look(vehicle: Int, atS: Double, reading: Int, sensedNs: Long = -1) extends Note

  /** A reading is predicted.
    *
    * @param reading number of the prediction
    * @param from number of the reading from which it starts
    */
  final case class Predict(vehicle: Int, atS: Double, reading: Int, from: Int, way: Propagation) extends Note

  /** A reading is added to a forecast whose state contains more than readings.
    *
    * @param from number of the previous reading of the forecast; 0 if there is none
    * @param way the steps from the previous reading to this one
    */
  final case class Enter(vehicle: Int, atS: Double, reading: Int, from: Int, way: Propagation) extends Note

  /** A vehicle's controller decides.
    *
    * @param before number of its previous decision; this decision's number is one more
    * @param elapsedS time since the previous decision
    * @param opponent number of the opponent's last known decision in a duel; else 0
    * @param ownAgeS age of the vehicle's own reading in a duel; else 0
    * @param opponentAgeS age of the opponent's reading in a duel; else 0
    * @param aheadS time by which a camera's estimate is predicted; −1 in loops without predictions
    * @param more further inputs, for teams that need them
    */
  final case class Decide(
      vehicle: Int,
      atS: Double,
      view: Int,
      before: Int,
      elapsedS: Double,
      opponent: Int,
      ownAgeS: Double,
      opponentAgeS: Double,
      aheadS: Option[Double],
      more: Option[More]
  ) extends Note

  /** Further inputs of a decision.
    *
    * @param known number of the last decision that was sent to each vehicle
    * @param agesS age of each vehicle's reading
    * @param actsInS time until the command takes effect; 0 in loops without predictions
    * @param timeS time at which the command takes effect, since the vehicle was first read
    */
  final class More(val known: Array[Int], val agesS: Array[Double], val actsInS: Double, val timeS: Double)

  /** The command of a decision takes effect. */
  final case class Act(vehicle: Int, atS: Double, decision: Int) extends Note

  final case class Score(atS: Double, view: Int) extends Note

  /** A flight with an end of its own may end.
    *
    * @param sinceS time since the first decision
    * @param agesS age of each vehicle's reading
    */
  final case class End(atS: Double, view: Int, sinceS: Double, agesS: Array[Double]) extends Note

  /** A sensor takes an image.
    *
    * @param bearingError error of the bearing, in standard deviations
    * @param rangeError error of the range, in standard deviations
    * @param isFound whether an opponent in view is detected
    */
  final case class Expose(
      vehicle: Int,
      atS: Double,
      view: Int,
      image: Int,
      bearingError: Double,
      rangeError: Double,
      isFound: Boolean
  ) extends Note

  /** An image's result becomes known.
    *
    * @param isOlder whether it was taken before image `last`
    * @param last the image that was taken last among those known before
    */
  final case class Join(vehicle: Int, atS: Double, image: Int, isOlder: Boolean, last: Int) extends Note
