package skein.loop

import org.apache.pekko.Done
import org.apache.pekko.stream.*
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.Future
import skein.flow.Newest
import skein.record.{Decision, EventKind}

/** [[StreamLoop]] that decides upon the future: each observation is carried forward to the moment at which the command
  * will act, by simulating every vehicle under the commands on their way to it. What the answers to commands tell is
  * fed back besides the commands themselves.
  */
object PredictiveLoop:

  def apply(team: Team, stop: SharedKillSwitch): RunnableGraph[Future[Done]] =
    of(team, stop)(vehicle => team.predict(vehicle).via(team.decide(vehicle)))

  /** @param decisions
    *   for one vehicle, upon the sights of each tick
    */
  private[loop] def of(team: Team, stop: SharedKillSwitch)(
      decisions: Int => Flow[Sight, Decision, ?]
  ): RunnableGraph[Future[Done]] =
    RunnableGraph.fromGraph(GraphDSL.createGraph(Sink.ignore) { implicit builder => done =>
      import GraphDSL.Implicits.*
      val percepts = builder.add(MergePreferred[Percept](team.vehicles.size + 1, eagerComplete = true))
      val everyone = builder.add(Broadcast[Sight](team.vehicles.size))
      val heard    = builder.add(Merge[Percept](team.vehicles.size))
      val fed      = builder.add(Broadcast[Percept](2))

      val start = team.now

      for vehicle <- team.vehicles do
        StreamLoop.locations(team, vehicle, start, stop).map(Percept.Read(_, _)) ~> percepts.in(vehicle)
        everyone ~> newest(team, vehicle).via(decisions(vehicle)) ~> team.steer(vehicle) ~> heard.in(vehicle)

      team.due(start).via(stop.flow) ~> percepts.in(team.vehicles.size)
      percepts ~> team.pictureWithForecast ~> everyone
      heard ~> fed ~> team.feedBackAll ~> percepts.preferred
      fed ~> done
      ClosedShape
    })

  /** A prediction is made for the moment of its decision: when the command can leave. */
  private def newest(team: Team, vehicle: Int) =
    Newest[Sight](_ => team.note(EventKind.Dropped, Some(vehicle), "not commanded within a period"))
