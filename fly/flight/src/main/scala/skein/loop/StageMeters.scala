package skein.loop

import java.util.concurrent.ConcurrentHashMap
import java.util.concurrent.atomic.AtomicLong
import org.apache.pekko.stream.Attributes
import scala.jdk.CollectionConverters.*
import skein.units.*

/** Counts the elements of a named part of a loop's graph. As an attribute of the part's operators, it names
  * them in the running graph ([[RunningGraph]]). One thread counts, any thread may read.
  *
  * @param of all meters of this graph
  */
final class StageMeter private[loop] (val name: String, private[loop] val of: StageMeters)
    extends Attributes.Attribute:
  private val count, entries     = AtomicLong()
  private val waits              = AtomicLong()
  @volatile private var aged     = false
  @volatile private var ageNanos = 0L

  def passed: Long = count.get

  /** Number of elements that entered the part. */
  def entered: Long = entries.get

  /** Number of unanswered calls of the part: requests and moves. */
  def unanswered: Long = waits.get

  /** Age of the oldest reading behind the newest element, when that left the part; absent if it used no
    * reading.
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
