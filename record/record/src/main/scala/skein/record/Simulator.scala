package skein.record

/** The simulator in which the vehicles of a flight fly. */
enum Simulator:
  /** Skein's own simulator, with the world of the recording's parameters. */
  case BuiltIn

  /** Another simulator, by its address, or by the name that a program gives it. */
  case Other(name: String)

  def label: String = this match
    case BuiltIn     => Simulator.BuiltInLabel
    case Other(name) => name

object Simulator:
  private val BuiltInLabel = "built-in"

  /** In formats up to 6, a comma and words for people follow `built-in`. */
  private[record] def ofLabel(label: String): Simulator =
    if label == BuiltInLabel || label.startsWith(s"$BuiltInLabel,") then BuiltIn else Other(label)
