package skein.signal

/** The reason why a text is not a latency profile. `message` states what was expected, what was received, and
  * where.
  */
enum LatencyError(val message: String):

  case UnknownProfile(text: String)
      extends LatencyError(s"unknown latency profile \"$text\"; expected ${LatencyError.forms}")

  /** The profile's name is valid, but the rest of the text is not. */
  case Malformed(text: String, expected: String, came: String)
      extends LatencyError(s"latency profile \"$text\": expected $expected, got \"$came\"")

  case Unreadable(path: String, reason: String)
      extends LatencyError(s"cannot read latency samples: $path: $reason")

  /** A line of the file of samples is not a round trip. Lines are counted from 1. */
  case BadSample(path: String, line: Int, came: String)
      extends LatencyError(s"$path:$line: expected a round trip in ms, zero or more, got \"$came\"")

  case NoSamples(path: String)
      extends LatencyError(s"$path: expected at least one round trip in ms, one a line; the file has none")

object LatencyError:
  val forms: String =
    "none, direct, vpn, vpn-mixed, constant:200ms, uniform:10ms..40ms, lognormal:36ms,0.3 " +
      "or file:PATH (times are round trips), or one of them after 'correlated:250ms,', 'rate:50mbit,', " +
      "'loss:5%,', 'loss:5%/4,', 'outage:1s/10s,' or 'reorder:2%/10ms,'"
