package skein.loop

import skein.vehicle.{ConstantTurn, ConstantVelocity, VehicleModel}

/** What the controller of a vehicle knows of the other ones. */
enum Knowledge(val label: String):
  /** Their readings, the commands sent to them, and their policies. */
  case All extends Knowledge("all")

  /** Their readings alone. A policy sees as another's heading the direction in which it moves. Where the loop
    * predicts, it predicts the others by [[Knowledge.stranger]].
    */
  case Positions extends Knowledge("positions")

object Knowledge:
  /** The model by which a vehicle is predicted whose commands are not known: the turn of its last two
    * readings goes on, unless its own model is straight on.
    */
  def stranger(model: VehicleModel[?]): VehicleModel[?] =
    if model == ConstantVelocity then ConstantVelocity else ConstantTurn

  def parse(text: String): Either[String, Knowledge] =
    values.find(_.label == text).toRight(s"expected ${values.map(_.label).mkString(" or ")}, came '$text'")
