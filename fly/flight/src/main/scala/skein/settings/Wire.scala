package skein.settings

import skein.units.Expect

/** The wire protocol of the vehicles' simulator. */
enum Wire(val label: String):
  case AirSim  extends Wire("airsim")
  case Mavlink extends Wire("mavlink")

object Wire:
  def parse(text: String): Either[String, Wire] = Expect.oneOf(values, text)(_.label)
