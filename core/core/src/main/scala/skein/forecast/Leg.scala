package skein.forecast

import skein.units.Span

/** A part of a vehicle's way through time: it flies for so long under one command.
  *
  * @param command absent before the first: the vehicle holds its place
  */
final case class Leg(command: Option[Commanded], span: Span)
