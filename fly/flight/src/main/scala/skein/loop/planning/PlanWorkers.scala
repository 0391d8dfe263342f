package skein.loop.planning

import java.util.concurrent.ConcurrentLinkedQueue
import java.util.concurrent.atomic.AtomicReference
import scala.util.control.NonFatal
import scala.util.{Failure, Success, Try}
import skein.planning.{JointPlan, JointPlanner, PlanProblem}

/** Searches plans. A problem is searched by several searches side by side that know nothing of each other, so
  * that what each finds depends on the number of its slices alone.
  */
trait PlanWorkers extends AutoCloseable:

  /** Begins a search.
    *
    * @param warm to begin with
    */
  def begin(problem: PlanProblem, warm: JointPlan): PlanSearch

object PlanWorkers:
  /** For loops that do not plan. */
  val none: PlanWorkers = new PlanWorkers:
    def begin(problem: PlanProblem, warm: JointPlan): PlanSearch =
      throw IllegalStateException("this flight was given no workers to plan with")
    def close(): Unit = ()

/** A search under way. */
trait PlanSearch:

  /** What each search has found so far. */
  def found: Vector[JointPlan]

  /** Ends it: what each search has found, the same from now on. */
  def finish(): Vector[JointPlan]

/** Searches at once, on the caller's thread, when its result is asked for: as many slices as are set,
  * whatever the clock says. So virtual time is deterministic.
  *
  * @param slices of each search; for several vehicles as many more as they need to get equally many
  */
final class CountedPlanWorkers(searches: Int, slices: Int) extends PlanWorkers:
  require(searches > 0 && searches <= PlanProblem.MostSearches, s"1 to ${PlanProblem.MostSearches} searches")
  require(slices >= 0, s"slices must not be negative, came $slices")

  private val planner = JointPlanner()

  def begin(problem: PlanProblem, warm: JointPlan): PlanSearch = new PlanSearch:
    lazy val found: Vector[JointPlan] =
      val vehicles = problem.parts.size
      val rounds   = (slices + vehicles - 1) / vehicles
      Vector.tabulate(searches)(planner.searched(problem, warm, _, rounds * vehicles))
    def finish(): Vector[JointPlan] = found

  def close(): Unit = ()

/** A thread that works slice by slice, and sleeps where there is nothing to do until it is woken. */
trait PlanThread extends AutoCloseable:

  /** Never blocks. */
  def wake(): Unit

/** Searches on threads of its own until it is asked for the result; several problems take turns, slice by
  * slice.
  *
  * @param threads and searches per problem
  * @param begun a thread that works on slices; each says whether there was anything to do
  */
final class ThreadedPlanWorkers(threads: Int, begun: (() => Boolean) => PlanThread) extends PlanWorkers:
  require(threads > 0 && threads <= PlanProblem.MostSearches, s"1 to ${PlanProblem.MostSearches} threads")

  // Without a lock, which a worker without the processor could keep the stream's thread waiting for.
  private val waiting = ConcurrentLinkedQueue[ThreadedPlanWorkers.Search]()
  private val workers = Vector.fill(threads):
    val planner = JointPlanner()
    begun: () =>
      val next = Option(waiting.poll())
      for search <- next if search.improve(planner) do
        val _ = waiting.add(search)
      next.isDefined

  def begin(problem: PlanProblem, warm: JointPlan): PlanSearch =
    val searches = Vector.tabulate(threads)(ThreadedPlanWorkers.Search(problem, warm, _))
    for search <- searches do
      val _ = waiting.add(search)
    workers.foreach(_.wake())
    new PlanSearch:
      def found: Vector[JointPlan]    = searches.map(_.found)
      def finish(): Vector[JointPlan] = searches.map(_.finish())

  /** Ends the threads; searches under way find nothing more. */
  def close(): Unit = workers.foreach(_.close())

private object ThreadedPlanWorkers:
  /** One search; worked on by one thread at a time. */
  final class Search(problem: PlanProblem, warm: JointPlan, number: Int):
    private val best  = AtomicReference(warm)
    private val ended = AtomicReference(Option.empty[Try[JointPlan]])

    def found: JointPlan = best.get

    /** Searches one slice more. A failure ends the search; whoever asks for its result is told.
      *
      * @return whether more are wanted
      */
    def improve(by: JointPlanner): Boolean =
      if ended.get.isEmpty then
        try best.set(by.improved(problem, best.get, number))
        catch
          case NonFatal(error) =>
            val _ = ended.compareAndSet(None, Some(Failure(error)))
      ended.get.isEmpty

    /** A slice that is searched now no longer counts. */
    def finish(): JointPlan =
      val _ = ended.compareAndSet(None, Some(Success(best.get)))
      ended.get.get.get
