package skein.loop.planning

import java.lang.foreign.{Arena, FunctionDescriptor, Linker, ValueLayout}
import java.nio.file.{Files, Path}
import java.util.concurrent.ThreadFactory
import java.util.concurrent.atomic.AtomicInteger
import scala.jdk.CollectionConverters.*
import scala.util.{Try, Using}

/** Threads that give way to all others of the user's session.
  *
  * Java's priorities have no effect on Linux, and niceness has none on how soon a thread runs that wakes up: it waits
  * until the one on its processor has used up its slice, some 3 to 5 ms, however nice that is. Only from a thread of
  * `SCHED_IDLE` (see sched(7)) is the processor taken at once. Any process may choose it, and may not go back. Its price:
  * where other programs of the session keep all processors busy, such a thread hardly runs, and the JVM, which stops all
  * threads now and then, waits for one that is ready to run; 0.8 s were seen.
  */
object BackgroundThread:

  /** Daemon threads that give way. */
  def factory(name: String): ThreadFactory =
    val count = AtomicInteger()
    (work: Runnable) =>
      val thread = Thread(
        () =>
          val _ = giveWay()
          work.run()
        ,
        s"$name-${count.incrementAndGet()}"
      )
      thread.setDaemon(true)
      thread.setPriority(Thread.MIN_PRIORITY)
      thread

  /** Makes the calling thread give way; says whether the system did so. */
  private[planning] def giveWay(): Boolean = isLinux && giveWay(CallingThread)

  /** Lowers the JVM's compiler threads to the scheduler's idle class. Call it after a warm-up, when most of the program is
    * compiled.
    *
    * @return
    *   how many the system made do so
    */
  def compilersGiveWay(): Int =
    if isLinux then Try(compilers.count(giveWay)).getOrElse(0) else 0

  private def compilers: Vector[Int] =
    Using.resource(Files.list(Path.of("/proc/self/task")))(_.iterator.asScala.toVector)
      .filter(task => CompilerNames.exists(nameOf(task).startsWith))
      .map(_.getFileName.toString.toInt)

  /** Empty where the thread has ended since it was listed. */
  private def nameOf(task: Path): String = Try(Files.readString(task.resolve("comm"))).getOrElse("")

  /** As HotSpot calls its compiler threads. */
  private val CompilerNames = Vector("C1 Comp", "C2 Comp")

  private def isLinux = System.getProperty("os.name") == "Linux"

  private def giveWay(thread: Int): Boolean =
    Try:
      val linker = Linker.nativeLinker()
      val call   = linker.downcallHandle(
        linker.defaultLookup().findOrThrow("sched_setscheduler"),
        FunctionDescriptor.of(
          ValueLayout.JAVA_INT,
          ValueLayout.JAVA_INT,
          ValueLayout.JAVA_INT,
          ValueLayout.ADDRESS
        )
      )
      Using.resource(Arena.ofConfined()): arena =>
        val priority       = arena.allocate(ValueLayout.JAVA_INT)
        val result: AnyRef = call.invokeWithArguments(Int.box(thread), Int.box(SchedIdle), priority)
        result == Int.box(0)
    .getOrElse(false)

  private val CallingThread = 0

  /** `SCHED_IDLE` in Linux's linux/sched.h. */
  private[planning] val SchedIdle = 5
