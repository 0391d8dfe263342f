package skein.forecast

import skein.units.Span

/** A part of a vehicle's predicted flight under one command.
  *
  * @param command None before the first command; the vehicle then holds its position
  */
final case class Leg(command: Option[Commanded], span: Span)
