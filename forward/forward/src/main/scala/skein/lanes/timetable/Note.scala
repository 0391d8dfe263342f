package skein.lanes.timetable

/** Something that happens in an episode, as [[TimetableNotes]] notes it. Each vehicle's readings and
  * decisions are numbered, and so are the views of all.
  */
private[lanes] sealed trait Note:
  /** When, since the episode's begin, s; a decision's: not before. */
  def atS: Double

private[lanes] object Note:
  /** A vehicle is read, or looked at for a score or an image. */
  final case class Look(vehicle: Int, atS: Double, reading: Int) extends Note

  /** A reading is carried forward.
    *
    * @param reading what it becomes
    * @param from the reading that is carried forward
    */
  final case class Predict(vehicle: Int, atS: Double, reading: Int, from: Int, way: Propagation) extends Note

  /** A reading enters a forecast that keeps what readings do not tell.
    *
    * @param from the one that entered before; 0: none did
    * @param way there
    */
  final case class Enter(vehicle: Int, atS: Double, reading: Int, from: Int, way: Propagation) extends Note

  /** A vehicle's controller decides.
    *
    * @param before the number of its decision before; this one's is one more
    * @param elapsedS since then
    * @param opponent in a duel: the number of the opponent's decision that is known; else 0
    * @param ownAgeS in a duel: of the own reading; else 0
    * @param opponentAgeS the same of the opponent's
    * @param aheadS of one who sees: for how long what is believed is carried on, or −1 where nothing is
    *   predicted
    * @param more of a team that asks for it
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

  /** What a decision is told besides.
    *
    * @param known by vehicle, the number of the decision that was sent last
    * @param agesS by vehicle, of its reading
    * @param actsInS until the command acts; 0 where nothing is predicted
    */
  final class More(val known: Array[Int], val agesS: Array[Double], val actsInS: Double)

  /** The command of a decision begins to act. */
  final case class Act(vehicle: Int, atS: Double, decision: Int) extends Note

  final case class Score(atS: Double, view: Int) extends Note

  /** A sensor takes an image.
    *
    * @param bearingError in standard deviations
    * @param rangeError the same
    * @param isFound whether what is in view is detected
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

  /** What an image shows is known.
    *
    * @param isOlder than the one that joined before
    * @param last the image that joined before
    */
  final case class Join(vehicle: Int, atS: Double, image: Int, isOlder: Boolean, last: Int) extends Note
