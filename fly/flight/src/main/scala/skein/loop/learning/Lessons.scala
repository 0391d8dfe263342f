package skein.loop.learning

import java.util.concurrent.atomic.{AtomicLong, AtomicReference}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.QueueOfferResult
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import scala.concurrent.{ExecutionContext, Future}
import scala.util.Try
import skein.flow.Learn

/** What a flight's policy hears of its learner, and tells it. */
trait Lessons:

  /** What is new; asked once before each decision. Never blocks.
    *
    * @param decision its number
    */
  def news(decision: Long): Vector[LearnerUpdate]

  /** Never blocks. */
  def flown(transition: Transition): Unit

  def close(): Unit = ()

/** What is new of a learner.
  *
  * @param text for a person
  * @param parameters of the policy that decides from now on, if it is another
  */
final case class LearnerUpdate(text: String, parameters: Option[Vector[Double]] = None)

/** Lessons by a learner that runs beside the flight: it may be slow, hang or fail, and no decision waits for
  * it. Of versions between two decisions the last counts.
  *
  * @param on what it learns on, slice by slice
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
    // A class that cannot be loaded would end the thread, and nobody would be told.
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
    // After learning has failed, which was told.
    case _ => ()

  override def close(): Unit =
    // Where learning failed, it is complete, which it says by an exception.
    val _ = Try(queue.complete())

object LessonsBeside:
  /** Decisions: of a flight of one vehicle, almost two minutes at 10 Hz. */
  val MostWaiting = 1024

  /** Few: a thread that gives way and gets no time is replaced between two slices only. */
  private val MostInSlice = 8
  private val MostSaid    = 16

/** The same lessons again. One thread at a time.
  *
  * @param recorded what was new before which decision; where that was made in the policy's place, it is new
  *   before the next
  */
final class LessonsAgain(recorded: Map[Long, Vector[LearnerUpdate]]) extends Lessons:
  private var left = recorded.toVector.sortBy(_._1)

  def news(decision: Long): Vector[LearnerUpdate] =
    val (fresh, later) = left.span(_._1 <= decision)
    left = later
    fresh.flatMap(_._2)

  def flown(transition: Transition): Unit = ()
