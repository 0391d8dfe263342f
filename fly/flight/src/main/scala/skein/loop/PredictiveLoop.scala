package skein.loop

import org.apache.pekko.stream.*
import org.apache.pekko.stream.scaladsl.*
import org.apache.pekko.{Done, NotUsed}
import scala.concurrent.Future
import skein.flow.Newest
import skein.record.EventKind

/** [[StreamLoop]] with prediction: each observation is predicted for the moment at which the command takes
  * effect, by simulating every vehicle under the commands on their way to it. Command answers are fed back in
  * addition to the commands.
  */
object PredictiveLoop:

  def apply(team: Team, stop: SharedKillSwitch): RunnableGraph[Future[Done]] =
    RunnableGraph.fromGraph(GraphDSL.createGraph(Sink.ignore) { implicit builder => end =>
      import GraphDSL.Implicits.*
      val observed = builder.add(Observed(team, stop))
      val cast     = builder.add(team.cast())
      val steered  = builder.add(team.steered)
      val fan      = builder.add(team.fan)

      observed ~> cast
      // The end overtakes waiting decisions: a vehicle that cannot be commanded accepts none of them.
      for vehicle <- team.own do
        cast ~> newest(team, Some(vehicle)) ~> team.predict(vehicle) ~>
          team.decide(vehicle).via(team.foresee(vehicle)).via(stop.flow) ~> team.steer(vehicle) ~> steered

      steered ~> fan
      fan ~> team.record
      fan ~> team.told ~> team.feedBackAll ~> observed
      fan ~> end
      ClosedShape
    })

  /** The newest request. A prediction is made at the moment of its decision, when the command can be sent. */
  private[loop] def newest(
      team: Team,
      vehicle: Option[Int]
  ): Flow[DecisionRequest, DecisionRequest, NotUsed] =
    Newest[DecisionRequest](_ => team.log.note(EventKind.Dropped, vehicle, "not commanded within a period"))
      .addAttributes(vehicle.fold(team.named("newest"))(team.named("newest", _)))
