package skein.solver

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{ExecutionContext, Future}
import skein.loop.{Chosen, Decider, JointPlanning, LoopKind, PlanSettings}
import skein.loop.planning.{PlanStage, PlanWorkers}
import skein.planning.{JointPlanner, PlanProblem}
import skein.policy.Fleet
import skein.settings.RecordedPlan
import skein.units.*

/** The deciders of one flight in another process: the vehicles' policies, and, if its loop plans, a planner
  * for those that plan.
  *
  * @param plans absent if no vehicle plans
  */
final class FlightDeciders(val fleet: Fleet, plans: Option[FlightDeciders.Plans] = None):

  // A planner serves one request at a time.
  private val planner = JointPlanner()

  /** The vehicles whose decisions are joint with a vehicle's, in their order; only itself unless it plans. */
  def together(vehicle: Int): Vector[Int] =
    plans.map(_.planning.vehicles).filter(_.contains(vehicle)).getOrElse(Vector(vehicle))

  /** Decides on this thread, or plans until the deadline of plans.
    *
    * @param held the memory of the answer that the request continues; absent if there is none
    * @param now the present time, on the controller's clock
    * @return a decision for each requested vehicle, and the new memory
    */
  def decide(question: Question, held: Option[Any], now: Instant)(using
      ActorSystem
  ): Future[(Vector[Chosen], Any)] =
    plans.filter(_.planning.vehicles.contains(question.vehicle)) match
      case Some(plans) =>
        import plans.planning
        // A policy that decides instead of a plan keeps no memory.
        val memories =
          question.deciders.map((vehicle, memory) => memory.copy(held = Decider(fleet, vehicle).start.held))
        val views   = memories.map(_ => question.view)
        val problem = PlanProblem(planning.planner, planning.pose(memories, views, now))
        // Every memory was made by this planner.
        val last = held.map(_.asInstanceOf[PlanStage.Answer])
        PlanStage
          .searched(problem, last, plans.deadline, plans.workers, planner)
          .map { answer =>
            val (_, made) = planning.decide(memories, views, now, problem.parts, answer)
            (made.map(one => Chosen(one.decision.action, Some(one.plan))), answer)
          }(using ExecutionContext.parasitic)
      case None =>
        val decider          = Decider(fleet, question.vehicle)
        val memory           = question.deciders.head.memory.copy(held = held.getOrElse(decider.start.held))
        val (next, decision) = decider.decide(memory, question.view, now)
        Future.successful((Vector(Chosen(decision.action)), next.held))

  def close(): Unit = plans.foreach(_.workers.close())

object FlightDeciders:

  /** The planner of a flight.
    *
    * @param deadline time from a request until the best plan found is used
    */
  final case class Plans(planning: JointPlanning, deadline: Span, workers: PlanWorkers)

  /** The deciders of a flight.
    *
    * @param workers the workers that search for a flight that plans
    * @return Left says why this process cannot plan it
    */
  def of(flown: RecordedPlan, workers: PlanSettings => PlanWorkers): Either[String, FlightDeciders] =
    val fleet = flown.plan.fleet(flown.settings)
    val how   = flown.settings.planning
    val plans =
      if flown.plan.loop != LoopKind.Plan then Right(None)
      else JointPlanning.of(fleet, flown.settings.loopSettings(flown.plan))
    plans.map(planning => FlightDeciders(fleet, planning.map(Plans(_, how.deadline, workers(how)))))
