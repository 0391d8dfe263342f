package skein.vtime

import java.security.CodeSource
import scala.concurrent.duration.FiniteDuration
import skein.vtime.agent.Agent

/** The reasons why a run in virtual time was stopped. */
enum Problem:

  /** The agent that redirects the clock is not active in this JVM, or was loaded too late for some classes.
    */
  case NoAgent(detail: String)

  /** A thread other than the loop's handed it a task or a timer, so the order of events would depend on
    * chance.
    */
  case ForeignThread(thread: String, action: String)

  /** Code on the loop would have blocked the only thread that could unblock it. */
  case Blocked(call: String)

  /** Code on the loop passed a task to threads outside virtual time. */
  case LeftTheLoop(executionContext: String)

  /** A dispatcher that needs threads of its own was requested. */
  case NeedsThreads(dispatcher: String)

  /** Sockets and name look-ups answer in real time and are not supported. */
  case Sockets

  /** Very many tasks ran and time did not advance; `running` holds what ran at the end, most frequent first.
    */
  case Livelock(at: FiniteDuration, tasks: Long, running: Seq[(String, Int)])

  /** No task and no timer is left, but the future is not completed. */
  case Deadlock(at: FiniteDuration, actors: String)

  /** The future was not completed within the limit of virtual time. */
  case Overrun(limit: FiniteDuration, actors: String)

  /** The loop's thread stood still in one task for this real time. */
  case Stuck(forReal: FiniteDuration)

  /** States what happened and what to do instead. */
  def message: String = this match
    case NoAgent(detail) =>
      s"""virtual time needs its agent, and it is not at work: $detail.
         |Start the JVM with -javaagent:${Problem.agentJar}; the README of vtime has the line for a build.""".stripMargin
    case ForeignThread(thread, action) =>
      s"thread '$thread' $action; only the loop's own thread may. Its stack trace is the cause below"
    case Blocked(call) =>
      s"$call would block the loop's thread; compose futures instead. The caller is in the cause below"
    case LeftTheLoop(executionContext) =>
      s"a task was handed to $executionContext, whose threads are not in virtual time; " +
        "use the actor system's dispatcher. The caller is in the cause below"
    case NeedsThreads(dispatcher) =>
      s"dispatcher '$dispatcher' is of type PinnedDispatcher, " +
        "which needs threads of its own; use type Dispatcher"
    case Sockets =>
      "TCP, UDP and DNS answer in real time and are not supported in virtual time; " +
        "give the code an in-memory transport"
    case Livelock(at, tasks, running) =>
      val ran = running.map((name, times) => s"\n  $times × $name").mkString
      s"$tasks tasks ran at ${at.toMillis} ms and time did not advance; of the last ones:$ran"
    case Deadlock(at, actors) =>
      s"at ${at.toMillis} ms nothing is left to run, yet the future is not completed; " +
        s"what should complete it was never started, is lost, or is on another thread. Actors:\n$actors"
    case Overrun(limit, actors) =>
      s"the future was not completed within $limit of virtual time. Actors:\n$actors"
    case Stuck(forReal) =>
      s"the loop's thread waited in one task for $forReal of real time. Where it stood is in the cause below"

object Problem:
  private def agentJar: String =
    val source: CodeSource | Null = classOf[Agent].getProtectionDomain.getCodeSource
    if source == null then "vtime-agent.jar" else source.getLocation.getPath

/** Thrown when a run was stopped; the cause, if there is one, has the culprit's stack. */
final class VirtualTimeException(val problem: Problem, cause: Throwable | Null = null)
    extends RuntimeException(problem.message, cause)
