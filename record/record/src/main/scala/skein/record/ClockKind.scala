package skein.record

/** The clocks of flights, by name. */
enum ClockKind(val label: String):
  case Real    extends ClockKind("real")
  case Virtual extends ClockKind("virtual")

object ClockKind:
  def parse(label: String): Either[String, ClockKind] =
    values.find(_.label == label).toRight(s"expected ${values.map(_.label).mkString(" or ")}, came '$label'")
