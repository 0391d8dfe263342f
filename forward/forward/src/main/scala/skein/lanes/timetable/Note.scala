package skein.lanes.timetable

/** An event of an episode, recorded by [[TimetableNotes]]. Each vehicle's readings and decisions are
  * numbered, and so are the views of all vehicles.
  */
private[lanes] sealed trait Note:
  def atS: Double

private[lanes] object Note:
  /** A vehicle is read, or its position is taken for a score or an image. */
  final case class Look(vehicle: Int, atS: Double, reading: Int) extends Note

  /** A reading is predicted.
    *
    * @param reading number of the prediction
    * @param from the reading it starts from
    */
  final case class Predict(vehicle: Int, atS: Double, reading: Int, from: Int, way: Propagation) extends Note

  /** A reading is added to a forecast whose state holds more than readings.
    *
    * @param from the reading added before; 0 for none
    * @param way the steps from the one to the other
    */
  final case class Enter(vehicle: Int, atS: Double, reading: Int, from: Int, way: Propagation) extends Note

  /** A vehicle's controller decides.
    *
    * @param before number of its previous decision; this one's is one more
    * @param elapsedS since then
    * @param opponent in a duel: number of the opponent's last known decision; else 0
    * @param ownAgeS in a duel: age of the own reading; else 0
    * @param opponentAgeS in a duel: age of the opponent's reading; else 0
    * @param aheadS with a camera: time for which an estimate is predicted, or −1 without prediction
    * @param more for a team that needs it
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
    * @param known by vehicle, number of the last sent decision
    * @param agesS by vehicle, age of its reading
    * @param actsInS until the command takes effect; 0 without prediction
    */
  final class More(val known: Array[Int], val agesS: Array[Double], val actsInS: Double)

  /** The command of a decision takes effect. */
  final case class Act(vehicle: Int, atS: Double, decision: Int) extends Note

  final case class Score(atS: Double, view: Int) extends Note

  /** A sensor takes an image.
    *
    * @param bearingError in standard deviations
    * @param rangeError in standard deviations
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
    * @param isOlder whether it was taken before the previous one that joined
    * @param last the previous image that joined
    */
  final case class Join(vehicle: Int, atS: Double, image: Int, isOlder: Boolean, last: Int) extends Note
