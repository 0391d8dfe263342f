package skein.loop

import skein.loop.planning.PlanStage
import skein.planning.{Part, PlannerSettings}
import skein.policy.{Fleet, Goal}
import skein.units.*

/** Joint plans for all vehicles of a scenario that plan: the pure core of the `plan` loop, which its replay
  * uses too.
  *
  * If no search finished for a vehicle during half a horizon, its own policy decides.
  *
  * @param vehicles indices in the scenario, at least one
  */
final class JointPlanning private (val vehicles: Vector[Int], plannings: Vector[Planning]):
  val planner: PlannerSettings = plannings.head.planner

  /** Time from a command's arrival until it takes effect on a vehicle. */
  val deadTime: Span = plannings.map(_.deadTime).max

  def regardsTeam(vehicle: Int): Boolean = plannings(vehicles.indexOf(vehicle)).regardsTeam

  /** The planning problems, indexed by vehicle.
    *
    * @param views the vehicles' views, with the estimates for the time at which the commands take effect
    */
  def pose(memories: Vector[Memory], views: Vector[TeamView], now: Instant): Vector[Part] =
    plannings.indices.toVector.map(index => plannings(index).pose(memories(index), views(index), now))

  /** The decisions for the plans found, indexed by vehicle. */
  def decide(
      memories: Vector[Memory],
      views: Vector[TeamView],
      now: Instant,
      parts: Vector[Part],
      answer: PlanStage.Answer
  ): (Vector[Memory], Vector[PlannedDecision]) =
    plannings.indices.toVector
      .map: index =>
        plannings(index).decide(
          memories(index),
          views(index),
          now,
          parts(index).copy(situation = answer.best.situation(index, parts(index))),
          answer.best.plans(index),
          answer.slices,
          isOld = answer.unsearchedS(index) > planner.horizonS / 2
        )
      .unzip

object JointPlanning:

  /** Joint planning for a fleet; None if no vehicle plans.
    *
    * @return Left says why planning does not support the models of vehicles or opponents
    */
  def of(fleet: Fleet, settings: LoopSettings): Either[String, Option[JointPlanning]] =
    import settings.{planning, seed}
    val vehicles = fleet.agents.indices.toVector.filter(vehicle => Planning.plans(fleet.agents(vehicle)))
    if vehicles.isEmpty then Right(None)
    else
      for
        known <- Expect.each((vehicles ++ OpponentModel.known(fleet)).distinct): vehicle =>
          ForeseenVehicle.of(fleet.agents(vehicle), settings.model(vehicle), planning).map(vehicle -> _)
      yield
        val foreseen  = known.toMap
        val plannings = vehicles.map: vehicle =>
          fleet.agents(vehicle).policy match
            case goal: Goal => TeamPlanning(fleet, vehicle, goal, foreseen(vehicle), planning, seed)
            case _          => PursuitPlanning(fleet, vehicle, foreseen, planning, seed)
        Some(JointPlanning(vehicles, plannings))
