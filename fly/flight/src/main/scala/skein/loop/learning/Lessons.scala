package skein.loop.learning

import java.util.concurrent.atomic.{AtomicLong, AtomicReference}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.QueueOfferResult
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import scala.concurrent.{ExecutionContext, Future}
import scala.util.Try
import skein.flow.Learn

/** The connection of a flight's policy with its learner, in both directions. */
trait Lessons:

  /** The updates since the last call; called once before each decision. Never blocks.
    *
    * @param decision number of the decision
    */
  def news(decision: Long): Vector[LearnerUpdate]

  def flown(transition: Transition): Unit

  def close(): Unit = ()

/** An update from a learner.
  *
  * @param text description for a person
  * @param parameters the policy's parameters from now on, if they change
  */
final case class LearnerUpdate(text: String, parameters: Option[Vector[Double]] = None)

/** Lessons by a learner that runs concurrently with the flight: it may be slow, hang or fail, and no decision
  * waits for it. If several versions arrive between two decisions, only the last is used.
  *
  * @param on executes the learner, slice by slice
  */
final class LessonsBeside(learner: FlownLearner, on: ExecutionContext)(using ActorSystem) extends Lessons:
  import LessonsBeside.*

  private val newest  = AtomicReference(Option.empty[LearnerUpdate])
  private val said    = AtomicReference(Vector.empty[LearnerUpdate])
  private val dropped = AtomicLong()
  private val told    = AtomicLong()
  private val learned = AtomicLong()
  private var version = 0

  private val (queue, ended) = Source
    .queue[Transition](MostWaiting)
    .via(Learn[Transition, (Vector[Double], Long)](MostWaiting, _ => dropped.incrementAndGet(): Unit):
      lesson =>
        lesson.grouped(MostInSlice).foldLeft(Future.successful(Option.empty[(Vector[Double], Long)])):
          (before, slice) =>
            before.flatMap(made => Future(learn(slice).orElse(made))(using on))(using
              ExecutionContext.parasitic
            ))
    .toMat(Sink.foreach(publish))((queue, ended) => (queue, ended))
    .run()

  ended.failed.foreach(error =>
    say(LearnerUpdate(s"learning failed, the policy stays as it is: $error"))
  )(using ExecutionContext.parasitic)

  private def learn(slice: Vector[Transition]): Option[(Vector[Double], Long)] =
    // A class that cannot be loaded would end the thread without a report.
    val made =
      try learner.learn(slice)
      catch case error: LinkageError => throw IllegalStateException(error)
    val seen = learned.addAndGet(slice.size)
    made.map((_, seen))

  private def publish(parameters: Vector[Double], transitions: Long): Unit =
    version += 1
    val wrong = parameters.count(!_.isFinite)
    if wrong > 0 then
      say(LearnerUpdate(s"version $version refused: $wrong of its ${parameters.size} numbers are not finite"))
    else
      newest.set(Some(LearnerUpdate(
        s"version $version decides from here, learned from $transitions flown decisions",
        Some(parameters)
      )))

  private def say(news: LearnerUpdate): Unit =
    said.updateAndGet(before => (before :+ news).takeRight(MostSaid)): Unit

  def news(decision: Long): Vector[LearnerUpdate] =
    val lost  = dropped.get
    val fresh = lost - told.getAndSet(lost)
    Option.when(fresh > 0)(
      LearnerUpdate(s"$fresh flown decisions are not learned from, $lost in all")
    ).toVector ++
      said.getAndSet(Vector.empty) ++ newest.getAndSet(None)

  def flown(transition: Transition): Unit = queue.offer(transition) match
    case QueueOfferResult.Dropped => dropped.incrementAndGet(): Unit
    // After learning has failed, which was reported.
    case _ => ()

  override def close(): Unit =
    // After learning has failed, the queue is complete already, and throws.
    val _ = Try(queue.complete())

object LessonsBeside:
  /** Maximum number of queued transitions: for one vehicle, almost two minutes at 10 Hz. */
  val MostWaiting = 1024

  /** Transitions per slice. Few: a low-priority thread without processor time is replaced between two slices
    * only.
    */
  private val MostInSlice = 8
  private val MostSaid    = 16

/** Repeats recorded lessons. One thread at a time.
  *
  * @param recorded the updates, by the decision before which they took effect; if a fallback made that
  *   decision, before the next
  */
final class LessonsAgain(recorded: Map[Long, Vector[LearnerUpdate]]) extends Lessons:
  private var left = recorded.toVector.sortBy(_._1)

  def news(decision: Long): Vector[LearnerUpdate] =
    val (fresh, later) = left.span(_._1 <= decision)
    left = later
    fresh.flatMap(_._2)

  def flown(transition: Transition): Unit = ()
