package skein.link

import java.lang.foreign.{Arena, FunctionDescriptor, Linker, MemoryLayout, ValueLayout}
import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import scala.util.{Try, Using}

/** Linux's policies for choosing between threads that could run, see sched(7). Java's priorities have no
  * effect there, and niceness has none on how soon a thread runs that wakes up: it waits until the one on its
  * processor has used up its slice, some 3 to 5 ms. Other systems have no such policies.
  *
  * @param number the policy's number in linux/sched.h
  * @param priority priority among threads of one policy
  */
enum SchedulingPolicy(private val number: Int, priority: Int):

  /** Runs when no other thread of the user's session needs the processor, and yields it immediately. Any
    * process may choose this policy but cannot leave it.
    */
  case Idle extends SchedulingPolicy(5, 0)

  /** Preempts every other thread immediately. Needs a privilege: root, `CAP_SYS_NICE`, or a limit of `ulimit
    * -r 2`. Threads that it starts have the ordinary policy. The system reserves a twentieth of the time for
    * other threads.
    */
  case RealTime extends SchedulingPolicy(2, 2)

  /** Preempts every thread but those of [[RealTime]], and needs its privilege. */
  case Favoured extends SchedulingPolicy(2, 1)

  /** Applies this policy to one of this process's threads.
    *
    * @param thread the system's number of the thread
    * @return whether the system applied it
    */
  def schedule(thread: Int): Boolean = SchedulingPolicy.isLinux && Try:
    Using.resource(Arena.ofConfined()): arena =>
      val flags = if this != Idle then SchedulingPolicy.ResetOnFork else 0
      SchedulingPolicy.setScheduler(
        thread,
        number | flags,
        arena.allocateFrom(ValueLayout.JAVA_INT, priority)
      )
  .getOrElse(false)

object SchedulingPolicy:
  private val isLinux = System.getProperty("os.name") == "Linux"

  /** The flag `SCHED_RESET_ON_FORK` in linux/sched.h. */
  private val ResetOnFork = 0x40000000

  /** The function sched_setscheduler(2), linked once: linking takes milliseconds, too long for a control
    * thread.
    */
  private lazy val setScheduler = function("sched_setscheduler", ValueLayout.ADDRESS)

  /** Links a function of the system that takes two numbers and a third argument.
    *
    * @return calls it; returns whether it returned 0
    */
  private[link] def function(name: String, third: MemoryLayout): (Int, Int, Any) => Boolean =
    val linker = Linker.nativeLinker()
    val handle = linker.downcallHandle(
      linker.defaultLookup().findOrThrow(name),
      FunctionDescriptor.of(ValueLayout.JAVA_INT, ValueLayout.JAVA_INT, ValueLayout.JAVA_INT, third)
    )
    (one, other, last) => handle.invokeWithArguments(one, other, last) == Int.box(0)

  /** The calling thread's number; None where the system does not report it. */
  def thisThread: Option[Int] =
    if isLinux then
      Try(Files.readSymbolicLink(Path.of("/proc/thread-self")).getFileName.toString.toInt).toOption
    else None

  /** This process's threads whose names begin with one of these; the system keeps 15 characters of a name.
    * Empty if the system does not list threads.
    */
  def threadsNamed(beginnings: String*): Vector[Int] =
    if isLinux then
      Try(Using.resource(Files.list(Path.of("/proc/self/task")))(_.iterator.asScala.toVector))
        .getOrElse(Vector.empty)
        .filter(task => beginnings.exists(nameOf(task).startsWith))
        .map(_.getFileName.toString.toInt)
    else Vector.empty

  /** A thread's name; empty if it has ended since it was listed. */
  private def nameOf(task: Path): String = Try(Files.readString(task.resolve("comm"))).getOrElse("")
