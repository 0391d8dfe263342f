package skein.loop.planning

import java.util.concurrent.ConcurrentLinkedQueue
import java.util.concurrent.atomic.AtomicReference
import scala.util.control.NonFatal
import scala.util.{Failure, Success, Try}
import skein.planning.{JointPlan, JointPlanner, PlanProblem}

/** Searches for plans. Several independent searches work on a problem in parallel, so each result depends
  * only on its number of slices.
  */
trait PlanWorkers extends AutoCloseable:

  /** Begins a search.
    *
    * @param warm the initial plan
    */
  def begin(problem: PlanProblem, warm: JointPlan): PlanSearch

object PlanWorkers:
  val none: PlanWorkers = new PlanWorkers:
    def begin(problem: PlanProblem, warm: JointPlan): PlanSearch =
      throw IllegalStateException("this flight was given no workers to plan with")
    def close(): Unit = ()

/** A running search for plans, until it is finished. */
trait PlanSearch:

  /** The present results, one for each search. */
  def found: Vector[JointPlan]

  /** Ends the search and returns the results, which are final. */
  def finish(): Vector[JointPlan]

/** Searches synchronously on the caller's thread when its result is requested: a configured number of slices,
  * whatever the clock reads. So virtual time is deterministic.
  *
  * @param slices number of slices of each search; for several vehicles rounded up to an equal number for each
  */
final class CountedPlanWorkers(searches: Int, slices: Int) extends PlanWorkers:
  require(searches > 0 && searches <= PlanProblem.MostSearches, s"1 to ${PlanProblem.MostSearches} searches")
  require(slices >= 0, s"slices must not be negative, got $slices")

  private val planner = JointPlanner()

  def begin(problem: PlanProblem, warm: JointPlan): PlanSearch = new PlanSearch:
    lazy val found: Vector[JointPlan] =
      val vehicles = problem.parts.size
      val rounds   = (slices + vehicles - 1) / vehicles
      Vector.tabulate(searches)(planner.searched(problem, warm, _, rounds * vehicles))
    def finish(): Vector[JointPlan] = found

  def close(): Unit = ()

/** A thread that works slice by slice, and sleeps without work until it is woken. */
trait PlanThread extends AutoCloseable:

  def wake(): Unit

/** Searches on separate threads until its result is requested; several problems take turns, slice by slice.
  *
  * @param threads number of threads, and of searches per problem
  * @param begun starts a thread for slices; each slice returns whether there was any work
  */
final class ThreadedPlanWorkers(threads: Int, begun: (() => Boolean) => PlanThread) extends PlanWorkers:
  require(threads > 0 && threads <= PlanProblem.MostSearches, s"1 to ${PlanProblem.MostSearches} threads")

  // Without a lock: a worker that holds one without processor time would block the stream's thread.
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

  /** Ends the threads; running searches find no further plans. */
  def close(): Unit = workers.foreach(_.close())

private object ThreadedPlanWorkers:
  /** One search; used by one thread at a time. */
  final class Search(problem: PlanProblem, warm: JointPlan, number: Int):
    private val best  = AtomicReference(warm)
    private val ended = AtomicReference(Option.empty[Try[JointPlan]])

    def found: JointPlan = best.get

    /** Searches one more slice. A failure ends the search, and is thrown to the caller that requests its
      * result.
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

    /** Ends the search; a slice that runs now does not count. */
    def finish(): JointPlan =
      val _ = ended.compareAndSet(None, Some(Success(best.get)))
      ended.get.get.get
