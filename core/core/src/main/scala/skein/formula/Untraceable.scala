package skein.formula

/** Thrown when a method cannot be compiled as arithmetic.
  *
  * @param reason the obstacle
  * @param where `Class.method (File:line)`, the innermost line of the user's own code; empty if unknown
  */
final class Untraceable(val reason: String, val where: String = "")
    extends RuntimeException(if where.isEmpty then reason else s"$where: $reason")
