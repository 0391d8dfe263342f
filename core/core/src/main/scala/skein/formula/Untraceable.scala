package skein.formula

/** A method is not arithmetic that can be compiled.
  *
  * @param reason what stands against it
  * @param where `Class.method (File:line)`, the innermost place of the user's own code; empty where it is not
  *   known
  */
final class Untraceable(val reason: String, val where: String = "")
    extends RuntimeException(if where.isEmpty then reason else s"$where: $reason")
