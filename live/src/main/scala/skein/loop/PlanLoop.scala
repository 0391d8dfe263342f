package skein.loop

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.SharedKillSwitch
import org.apache.pekko.stream.scaladsl.RunnableGraph
import scala.concurrent.Future

/** [[PredictiveLoop]] that plans: for the vehicles of a [[JointPlanning]], thousands of manoeuvres are flown forward from
  * the estimates of each tick until the deadline, each vehicle's against the plans of all others, and the first actions of
  * the best ones are commanded. Estimates are of the moment at which those commands will act. All other vehicles decide
  * as in [[PredictiveLoop]].
  */
object PlanLoop:

  def apply(team: Team, stop: SharedKillSwitch)(using ActorSystem): RunnableGraph[Future[Done]] =
    PredictiveLoop.of(
      team,
      stop,
      team.planning.map: planning =>
        val lead = team.settings.planning.deadline + planning.deadTime
        (planning.vehicles, team.predict(planning.vehicles, lead).via(team.plan(planning)))
    )
