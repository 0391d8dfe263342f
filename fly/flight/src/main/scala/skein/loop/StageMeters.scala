package skein.loop

import java.util.concurrent.ConcurrentHashMap
import java.util.concurrent.atomic.AtomicLong
import org.apache.pekko.stream.Attributes
import scala.jdk.CollectionConverters.*
import skein.units.*

/** What has passed a named part of a loop's graph. As an attribute of the operators that the part consists
  * of, it names them in the running graph ([[RunningGraph]]). One thread counts, any reads.
  *
  * @param of the meters of the same graph
  */
final class StageMeter private[loop] (val name: String, private[loop] val of: StageMeters)
    extends Attributes.Attribute:
  private val count, entries     = AtomicLong()
  private val waits              = AtomicLong()
  @volatile private var aged     = false
  @volatile private var ageNanos = 0L

  /** Elements that left the part. */
  def passed: Long = count.get

  /** Elements that came to the part. */
  def entered: Long = entries.get

  /** Calls of the part that are unanswered: questions asked, moves sent. */
  def unanswered: Long = waits.get

  /** How old the oldest reading was that the newest element was made from, when it left; absent where none
    * was.
    */
  def age: Option[Span] = Option.when(aged)(Span.ofNanos(ageNanos))

  private[loop] def enter(): Unit = entries.incrementAndGet(): Unit

  private[loop] def pass(): Unit = count.incrementAndGet(): Unit

  private[loop] def pass(age: Option[Span]): Unit =
    pass()
    age.foreach: span =>
      ageNanos = span.toNanos
      aged = true

  private[loop] def called(): Unit   = waits.incrementAndGet(): Unit
  private[loop] def answered(): Unit = waits.decrementAndGet(): Unit

/** The meters of one graph, by the names of its parts. */
final class StageMeters:
  private val meters = ConcurrentHashMap[String, StageMeter]()

  def apply(name: String): StageMeter = meters.computeIfAbsent(name, StageMeter(_, this))

  def all: Vector[StageMeter] = meters.values.asScala.toVector.sortBy(_.name)
