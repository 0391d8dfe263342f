package skein.record

import skein.units.Expect

/** The kinds of clock that a flight may run on, with their labels. */
enum ClockKind(val label: String):
  case Real    extends ClockKind("real")
  case Virtual extends ClockKind("virtual")

object ClockKind:
  def parse(label: String): Either[String, ClockKind] = Expect.oneOf(values, label)(_.label)
