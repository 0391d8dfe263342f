package skein.vtime

import java.util.ArrayDeque
import java.util.SplittableRandom
import java.util.random.RandomGenerator
import scala.concurrent.duration.*
import scala.concurrent.{BlockContext, CanAwait}
import skein.vtime.agent.{Environment, Redirect}

/** The run-to-completion loop: one thread, a first-in-first-out queue of tasks, and timers. Time advances to
  * the next timer only when the queue is empty.
  *
  * Made and run on one thread. All other threads may only read [[nanoTime]].
  */
private final class Loop(seed: Long, limits: RunLimits) extends Environment with BlockContext:
  val thread                                                 = Thread.currentThread
  private val queue                                          = ArrayDeque[Runnable]()
  private val timers                                         = TimerQueue()
  private var now                                            = Loop.epochNanos
  private var tasks, fired, instants, tasksThisTime          = 0L
  private var supervisors                                    = 0
  private var booting                                        = true
  private var sampled                                        = Map.empty[String, Int]
  private var takenAtFirstLook                               = 0L
  private var isOverlong                                     = false
  @volatile private var failure: VirtualTimeException | Null = null

  val random: RandomGenerator = SplittableRandom(seed)

  def nanoTime(): Long        = now
  def elapsed: FiniteDuration = (now - Loop.epochNanos).nanos
  def counts: RunCounts       = RunCounts(tasks, fired, instants)

  def post(task: Runnable): Unit =
    requireOwnThread(s"posted ${TaskName.of(task)}")
    queue.add(task): Unit

  def schedule(delay: FiniteDuration, task: Runnable): Timer =
    requireOwnThread(s"set a timer of $delay for ${TaskName.of(task)}")
    val nanos = delay.toNanos.max(0)
    timers.add(if now > Long.MaxValue - nanos then Long.MaxValue else now + nanos, task)

  def cancel(timer: Timer): Unit =
    requireOwnThread(s"cancelled a timer for ${TaskName.of(timer.task)}")
    timers.cancel(timer)

  /** Empties the timers; returns their tasks in the order in which they would have run. */
  def removeTimers(): Seq[Runnable] = timers.removeAll().map(_.task)

  /** Records the problem, which ends the run even if the exception is caught. */
  def fail(problem: Problem, culprit: Throwable = Culprit()): VirtualTimeException =
    val error = VirtualTimeException(problem, culprit)
    if failure == null then failure = error
    error

  inline def requireOwnThread(inline action: String): Unit =
    if Thread.currentThread ne thread then
      throw fail(Problem.ForeignThread(Thread.currentThread.getName, action))

  def supervisorName(): String =
    supervisors += 1
    s"StreamSupervisor-$supervisors"

  def blocked(call: String): VirtualTimeException = fail(Problem.Blocked(call))

  /** Refuses the global context and those made by `ExecutionContext.fromExecutor`: they share a prefix of
    * their class names.
    */
  def submitted(executionContext: Object): Unit =
    if executionContext.getClass.getName.startsWith("scala.concurrent.impl.ExecutionContextImpl") then
      throw fail(Problem.LeftTheLoop(executionContext.toString))

  /** Handles `Await` and `blocking`. Pekko awaits its own actors while a system starts: then the queue is run
    * first.
    */
  def blockOn[A](thunk: => A)(using CanAwait): A =
    if !booting then throw blocked("Await or blocking")
    while !queue.isEmpty do
      runNext()
      checkFailure()
    thunk

  /** Makes this loop the calling thread's environment during `body`. */
  def governing[A](body: => A): A =
    Redirect.setEnvironment(this)
    val watchdog =
      Watchdog(
        thread,
        () => begun,
        limits.standstill,
        fail(Problem.Stuck(limits.standstill), _): Unit,
        tellEndless
      )
    try BlockContext.withBlockContext(this)(body)
    catch case _: Throwable if failure != null => throw failure.nn // it is the cause of later exceptions
    finally
      watchdog.stop()
      if failure != null then
        Thread.interrupted(): Unit // the watchdog's interrupt; it is not meant for later code
      Redirect.setEnvironment(null)

  private def tellEndless(stack: Array[StackTraceElement]): Unit =
    val at = stack.find(frame => !Loop.libraries.exists(frame.getClassName.startsWith))
    System.err.println(
      s"virtual time: one task has computed for ${limits.standstill} and has not ended" +
        at.fold("")(frame => s"; it is at $frame")
    )

  /** Number of tasks that have begun; other threads may read it with a delay. */
  def begun: Long = tasks

  /** Ends the start-up of the system: from now on, blocking is an error. */
  def booted(): Unit = booting = false

  /** Runs tasks and advances time until `done`. `actors` describes the live actors, for a report. */
  def runUntil(done: () => Boolean)(actors: => String): Unit =
    checkFailure()
    while !done() do
      if queue.isEmpty then advance(actors) else runNext()
      checkFailure()

  private def checkFailure(): Unit =
    val interrupted = Thread.interrupted()
    val error       = failure
    if error != null then throw error // the watchdog interrupts, too
    if interrupted then throw InterruptedException("interrupted in virtual time")

  private def runNext(): Unit =
    val task = queue.poll()
    tasks += 1
    tasksThisTime += 1
    if tasksThisTime > limits.tasksPerInstant || isOverlong then sample(task)
    else if tasksThisTime % Loop.tasksPerLook == 0 then lookAtProcessor()
    task.run()

  /** Reads the processor time, relative to the first reading, so that one long task does not count. Not
    * called for every task, since a reading takes as long as a short task.
    */
  private def lookAtProcessor(): Unit =
    val taken = Watchdog.processorNanos(thread)
    if tasksThisTime == Loop.tasksPerLook then takenAtFirstLook = taken
    isOverlong = taken >= 0 && taken - takenAtFirstLook > limits.processorPerInstant.toNanos

  private def advance(actors: => String): Unit =
    timers.head match
      case None        => throw VirtualTimeException(Problem.Deadlock(elapsed, actors))
      case Some(timer) =>
        if timer.dueNanos - Loop.epochNanos > limits.duration.toNanos then
          throw VirtualTimeException(Problem.Overrun(limits.duration, actors))
        if timer.dueNanos > now then
          now = timer.dueNanos
          instants += 1
          tasksThisTime = 0
          isOverlong = false
          sampled = Map.empty
        timers.removeHead()
        fired += 1
        queue.add(timer.task): Unit

  /** Counts, beyond the limit, which tasks run for a while longer, and then reports them. */
  private def sample(task: Runnable): Unit =
    sampled = sampled.updatedWith(TaskName.of(task))(times => Some(times.getOrElse(0) + 1))
    if sampled.values.sum >= Loop.sampleSize then
      val running = sampled.toSeq.sortBy((name, times) => (-times, name)).take(10)
      throw VirtualTimeException(Problem.Livelock(elapsed, tasksThisTime, running))

private object Loop:
  private val libraries = Seq("java.", "jdk.", "scala.")

  /** The start of virtual time, 2000-01-01T00:00:00Z, so that equal seeds give equal time stamps. */
  val epochNanos: Long = 946_684_800_000_000_000L

  private val sampleSize = 1000

  /** Tasks at one instant between two readings of the processor time. */
  private val tasksPerLook = 256L

  def current: Loop = Redirect.environment() match
    case loop: Loop => loop
    case _ => throw IllegalStateException("no loop on this thread: start the system by VirtualTime.run")
