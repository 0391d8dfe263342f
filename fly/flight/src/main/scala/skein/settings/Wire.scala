package skein.settings

/** The wire protocol of the vehicles' simulator. */
enum Wire(val label: String):
  case AirSim  extends Wire("airsim")
  case Mavlink extends Wire("mavlink")

object Wire:
  def parse(text: String): Either[String, Wire] =
    values.find(_.label == text).toRight(s"expected ${values.map(_.label).mkString(" or ")}, came '$text'")
