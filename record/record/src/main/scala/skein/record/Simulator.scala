package skein.record

/** The simulator in which the vehicles of a flight fly. */
enum Simulator:
  /** Skein's own, with the world of the recording's parameters. */
  case BuiltIn

  /** Another, by its address, or by the name that a program gives it. */
  case Other(name: String)

  def label: String = this match
    case BuiltIn     => Simulator.BuiltInLabel
    case Other(name) => name

object Simulator:
  private val BuiltInLabel = "built-in"

  /** Up to format 6, words for people stood behind `built-in` and a comma. */
  private[record] def ofLabel(label: String): Simulator =
    if label == BuiltInLabel || label.startsWith(s"$BuiltInLabel,") then BuiltIn else Other(label)
