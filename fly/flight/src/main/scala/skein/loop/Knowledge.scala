package skein.loop

/** What the controller of a vehicle knows of the other ones. */
enum Knowledge(val label: String):
  /** Their readings, the commands sent to them, and their policies. */
  case All extends Knowledge("all")

  /** Their readings alone. A policy sees as another's heading the direction in which it moves. Where the loop
    * predicts, it predicts the others straight on.
    */
  case Positions extends Knowledge("positions")

object Knowledge:
  def parse(text: String): Either[String, Knowledge] =
    values.find(_.label == text).toRight(s"expected ${values.map(_.label).mkString(" or ")}, came '$text'")
