package skein.loop

import skein.loop.planning.PlanStage
import skein.planning.{Part, PlannerSettings}
import skein.policy.{Fleet, Goal}
import skein.units.*

/** Plans for all vehicles of a scenario that plan, together: the pure core of the `plan` loop, which its
  * replay uses too.
  *
  * Where nothing was searched for a vehicle for half a horizon, its own policy decides.
  *
  * @param vehicles by their places in the scenario, at least one
  */
final class JointPlanning private (val vehicles: Vector[Int], plannings: Vector[Planning]):
  val planner: PlannerSettings = plannings.head.planner

  /** How long after its arrival a command begins to act on a vehicle. */
  val deadTime: Span = plannings.map(_.deadTime).max

  def regardsTeam(vehicle: Int): Boolean = plannings(vehicles.indexOf(vehicle)).regardsTeam

  /** What is planned for, by vehicle.
    *
    * @param views with the estimates of when the commands will act
    */
  def pose(memories: Vector[Memory], views: Vector[TeamView], now: Instant): Vector[Part] =
    plannings.indices.toVector.map(index => plannings(index).pose(memories(index), views(index), now))

  /** The decisions for what was found, by vehicle. */
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
          isOld = answer.unsearchedS(index) > planner.horizonS / 2
        )
      .unzip

object JointPlanning:

  /** Absent where nobody plans.
    *
    * @return or why the vehicles that plan, or their opponents, cannot be planned by their models
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
