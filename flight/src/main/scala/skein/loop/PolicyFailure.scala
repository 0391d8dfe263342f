package skein.loop

import skein.policy.Agent

/** A policy threw something, or answered with nothing that a vehicle could be told. */
final class PolicyFailure private (agent: Agent, reason: String, cause: Throwable)
    extends RuntimeException(s"the policy of ${agent.name} $reason", cause)

private object PolicyFailure:

  /** What a policy answers, its own mistakes told with its vehicle and the line. What came of a connection
    * ([[java.io.IOException]]) is told as it is.
    */
  def told[A](agent: Agent)(answer: => A): A =
    // Not `NonFatal`: a recursion without end and a class that is missing are mistakes of the policy too.
    val came =
      try Option(answer)
      catch
        case mistake: (RuntimeException | StackOverflowError | LinkageError | AssertionError |
              NotImplementedError) =>
          throw PolicyFailure(agent, s"failed: $mistake${line(mistake).fold("")(" (" + _ + ")")}", mistake)
    came.getOrElse(throw PolicyFailure(agent, "answered null", null))

  /** @param action or a place
    * @throws PolicyFailure if there is none, or a number in it is not finite
    */
  def expectAction(agent: Agent, action: Any): Unit =
    if !isFinite(action) then throw PolicyFailure(agent, s"decided for what no vehicle can do: $action", null)

  private def isFinite(part: Any): Boolean = part match
    case null           => false
    case number: Double => number.isFinite
    case parts: Product => parts.productIterator.forall(isFinite)
    case _              => true

  /** Where the policy itself was, rather than what it called. */
  private def line(mistake: Throwable): Option[String] =
    mistake.getStackTrace
      .find(frame => !Libraries.exists(frame.getClassName.startsWith))
      .map(frame => s"${frame.getFileName}:${frame.getLineNumber}")

  private val Libraries = Seq("java.", "jdk.", "scala.")
