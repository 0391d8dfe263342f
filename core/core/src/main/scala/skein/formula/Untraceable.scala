package skein.formula

/** A method cannot be compiled as arithmetic.
  *
  * @param reason what prevents it
  * @param where `Class.method (File:line)`, the innermost line of the user's own code; empty where it is not
  *   known
  */
final class Untraceable(val reason: String, val where: String = "")
    extends RuntimeException(if where.isEmpty then reason else s"$where: $reason")
