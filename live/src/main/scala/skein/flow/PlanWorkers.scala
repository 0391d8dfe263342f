package skein.flow

import java.util.concurrent.ConcurrentLinkedQueue
import java.util.concurrent.atomic.AtomicReference
import java.util.concurrent.locks.LockSupport
import scala.collection.mutable
import skein.planning.{Objective, Plan, Planner, PlannerSettings, Situation}

/** A search to be run.
  *
  * @param warm
  *   to begin with
  * @param stream
  *   of random numbers
  */
final case class PlanProblem(
    settings: PlannerSettings,
    objective: Objective,
    situation: Situation,
    warm: Plan,
    stream: Long
):

  /** The stream of one of several searches side by side. */
  def streamOf(search: Int): Long = stream * PlanProblem.MostSearches + search

object PlanProblem:
  /** Searches side by side. */
  val MostSearches = 64

/** Searches plans. A problem is searched by several searches side by side that know nothing of each other, so that what
  * each finds depends on the number of its slices alone.
  */
trait PlanWorkers extends AutoCloseable:

  /** Begins a search. */
  def begin(problem: PlanProblem): PlanSearch

object PlanWorkers:
  /** For loops that do not plan. */
  val none: PlanWorkers = new PlanWorkers:
    def begin(problem: PlanProblem): PlanSearch =
      throw IllegalStateException("this flight was given no workers to plan with")
    def close(): Unit = ()

/** A search under way. */
trait PlanSearch:

  /** What each search has found so far. */
  def found: Vector[Plan]

  /** Ends it: what each search has found, the same from now on. */
  def finish(): Vector[Plan]

/** Searches at once, on the caller's thread, when its result is asked for: as many slices as are set, whatever the
  * clock says. So virtual time is deterministic.
  */
final class CountedPlanWorkers(searches: Int, slices: Int) extends PlanWorkers:
  require(searches > 0 && searches <= PlanProblem.MostSearches, s"1 to ${PlanProblem.MostSearches} searches")
  require(slices >= 0, s"slices must not be negative, came $slices")

  private val planners = Planners()

  def begin(problem: PlanProblem): PlanSearch = new PlanSearch:
    lazy val found: Vector[Plan] = Vector.tabulate(searches)(planners.searched(problem, _, slices))
    def finish(): Vector[Plan]   = found

  def close(): Unit = ()

/** The planners of one thread, by what they plan for: at most [[Planners.Limit]], then all are made anew. */
final class Planners:
  private val made = mutable.Map.empty[(PlannerSettings, Objective), Planner]

  def of(settings: PlannerSettings, objective: Objective): Planner =
    if made.size > Planners.Limit then made.clear()
    made.getOrElseUpdate((settings, objective), Planner(settings, objective))

  /** What one search finds in so many slices. */
  def searched(problem: PlanProblem, search: Int, slices: Int): Plan =
    val planner = of(problem.settings, problem.objective)
    Iterator
      .iterate(problem.warm)(planner.improve(_, problem.situation, problem.streamOf(search)))
      .drop(slices)
      .next()

object Planners:
  val Limit = 8

/** Searches on threads of its own until it is asked for the result; several problems take turns, slice by slice. The
  * threads give way to others ([[BackgroundThread]]), so that control traffic takes the processor from them.
  *
  * @param threads
  *   and searches per problem
  */
final class ThreadedPlanWorkers(threads: Int) extends PlanWorkers:
  require(threads > 0 && threads <= PlanProblem.MostSearches, s"1 to ${PlanProblem.MostSearches} threads")

  // Without a lock, which a worker without the processor could keep the stream's thread waiting for.
  private val waiting            = ConcurrentLinkedQueue[ThreadedPlanWorkers.Search]()
  @volatile private var isClosed = false
  private val factory            = BackgroundThread.factory("skein-plan")
  private val workers            = Vector.fill(threads)(factory.newThread(() => work()))
  workers.foreach(_.start())

  def begin(problem: PlanProblem): PlanSearch =
    val searches = Vector.tabulate(threads)(ThreadedPlanWorkers.Search(problem, _))
    for search <- searches do
      val _ = waiting.add(search)
    workers.foreach(LockSupport.unpark)
    new PlanSearch:
      def found: Vector[Plan]    = searches.map(_.found)
      def finish(): Vector[Plan] = searches.map(_.finish())

  /** Ends the threads; searches under way find nothing more. */
  def close(): Unit =
    isClosed = true
    workers.foreach(LockSupport.unpark)

  private def work(): Unit =
    val planners = Planners()
    while !isClosed do
      Option(waiting.poll()) match
        case None         => LockSupport.park(this)
        case Some(search) =>
          if search.improve(planners.of(search.problem.settings, search.problem.objective)) then
            val _ = waiting.add(search)

private object ThreadedPlanWorkers:

  /** One search; worked on by one thread at a time. */
  final class Search(val problem: PlanProblem, number: Int):
    private val best  = AtomicReference(problem.warm)
    private val ended = AtomicReference(Option.empty[Plan])

    def found: Plan = best.get

    /** Searches one slice more.
      *
      * @return
      *   whether more are wanted
      */
    def improve(by: Planner): Boolean =
      if ended.get.isEmpty then best.set(by.improve(best.get, problem.situation, problem.streamOf(number)))
      ended.get.isEmpty

    /** A slice that is searched now no longer counts. */
    def finish(): Plan =
      val _ = ended.compareAndSet(None, Some(best.get))
      ended.get.get
