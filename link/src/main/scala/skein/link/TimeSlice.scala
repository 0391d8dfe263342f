package skein.link

import java.lang.foreign.{Arena, FunctionDescriptor, Linker, MemorySegment, ValueLayout}
import scala.util.{Try, Using}
import skein.units.*

/** How long Linux lets a thread run before another of the same processor has its turn.
  *
  * A thread that wakes up while another one runs there waits for the end of that one's slice, which the kernel sees at its
  * next tick: up to 4 ms, where it needs 0.1 ms itself. Since Linux 6.12 a thread may ask for shorter slices, and then has
  * its turn sooner and no more time in all: sched_setattr(2), `sched_runtime` of a normal thread. That needs no privilege.
  * Older kernels take the request and change nothing.
  */
object TimeSlice:

  /** The shortest that Linux grants, and about what a reading or a command needs. */
  val shortest: Span = Span.ofNanos(100_000)

  /** Asks for the shortest slices, for the calling thread and all that it and its descendants start from then on. A command
    * that acts by the clock calls it first. Threads that the JVM started before, which compile and collect, keep theirs.
    *
    * @return
    *   what the thread has then; `None` where the system tells of no slices
    */
  def shorten(): Option[Span] =
    calls.flatMap: numbers =>
      Using.resource(Arena.ofConfined()): arena =>
        val wanted = arena.allocate(Size, 8)
        wanted.set(ValueLayout.JAVA_INT, 0, Size.toInt)
        wanted.set(ValueLayout.JAVA_LONG, RuntimeAt, shortest.toNanos)
        val _ = system(numbers.set, wanted, NoFlags)
        granted(numbers, arena)

  /** Of the calling thread. */
  private[link] def current: Option[Span] =
    calls.flatMap(numbers => Using.resource(Arena.ofConfined())(granted(numbers, _)))

  private def granted(numbers: Calls, arena: Arena): Option[Span] =
    val found = arena.allocate(Size, 8)
    Option
      .when(system(numbers.get, found, Size.toInt))(found.get(ValueLayout.JAVA_LONG, RuntimeAt))
      .filter(_ > 0)
      .map(Span.ofNanos(_))

  /** Numbers of Linux's system calls. */
  private final case class Calls(set: Long, get: Long)

  /** From asm/unistd_64.h and asm-generic/unistd.h. */
  private val calls: Option[Calls] = (System.getProperty("os.name"), System.getProperty("os.arch")) match
    case ("Linux", "amd64")   => Some(Calls(314, 315))
    case ("Linux", "aarch64") => Some(Calls(274, 275))
    case _                    => None

  /** Of `struct sched_attr`, and where `sched_runtime` stands in it (linux/sched/types.h). */
  private val Size      = 48L
  private val RuntimeAt = 24L

  private val CallingThread = 0
  private val NoFlags       = 0

  private lazy val syscall = Try:
    val linker = Linker.nativeLinker()
    linker.downcallHandle(
      linker.defaultLookup().findOrThrow("syscall"),
      FunctionDescriptor.of(
        ValueLayout.JAVA_LONG,
        ValueLayout.JAVA_LONG,
        ValueLayout.JAVA_INT,
        ValueLayout.ADDRESS,
        ValueLayout.JAVA_INT,
        ValueLayout.JAVA_INT
      ),
      Linker.Option.firstVariadicArg(1)
    )
  .toOption

  /** The setter takes flags where the getter takes a size, and the getter takes flags behind that. */
  private def system(number: Long, attributes: MemorySegment, third: Int): Boolean =
    syscall.exists: call =>
      val result: AnyRef = call.invokeWithArguments(
        Long.box(number),
        Int.box(CallingThread),
        attributes,
        Int.box(third),
        Int.box(NoFlags)
      )
      result == Long.box(0)
