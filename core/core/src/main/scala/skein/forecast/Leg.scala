package skein.forecast

import skein.units.Span

/** A stretch of a vehicle's predicted flight under one command.
  *
  * @param command absent before the first: the vehicle holds its position
  */
final case class Leg(command: Option[Commanded], span: Span)
