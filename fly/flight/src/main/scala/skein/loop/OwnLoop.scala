package skein.loop

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.SharedKillSwitch
import org.apache.pekko.stream.scaladsl.RunnableGraph
import scala.concurrent.Future
import skein.record.LoopKind
import skein.scenario.{NamedLoop, Scenarios}
import skein.units.Span

/** The loop of a flight: one of Skein's loops, or a user's own loop. */
type AnyLoop = LoopKind | OwnLoop

object AnyLoop:
  def names(using scenarios: Scenarios): Vector[String] =
    LoopKind.values.toVector.map(_.label) ++ scenarios.loops.map(_.name)

  /** The loop of this name; Left says what was expected and what was given. */
  def parse(name: String)(using scenarios: Scenarios): Either[String, AnyLoop] =
    scenarios.loops
      .collectFirst { case own: OwnLoop if own.name == name => own }
      .toRight(())
      .orElse(LoopKind.parse(name))
      .left
      .map: _ =>
        val several = if name.contains(',') then "; several as --loop ONE --loop OTHER" else ""
        s"no loop '$name': expected one of ${names.mkString(", ")}$several"

/** A control loop of a user's own: a graph of a [[Team]]'s operators. It is recorded, reported, run in
  * virtual time and replayed like Skein's loops; [[StreamLoop]] uses these operators and is an example.
  *
  * @param name the loop's name in recordings, tables and pictures; must differ from the names of Skein's
  *   loops
  * @param graph ends its sources when the switch is shut down, and completes its future when every command
  *   has ended; after [[OwnLoop.Grace]] it is aborted. In any case the vehicles are commanded to hover
  *   afterwards
  */
final class OwnLoop(
    val name: String,
    val graph: ActorSystem ?=> (Team, SharedKillSwitch) => RunnableGraph[Future[Done]]
) extends NamedLoop:
  require(
    name.matches("[a-z][a-z0-9-]{0,39}"),
    s"a loop's name: expected up to 40 small letters, digits and dashes, got '$name'"
  )
  require(LoopKind.parse(name).isLeft, s"a loop's name: expected none of Skein's own, got '$name'")

object OwnLoop:
  /** Time after the switch was shut down in which a graph must end before it is aborted. More than a command
    * takes to be answered or to time out.
    */
  val Grace: Span = Span.ofSeconds(30)

  /** The graph of this name had not ended within [[Grace]] after its switch was shut down. */
  final class BrokenOff(name: String)
      extends RuntimeException(s"the loop $name had not ended ${Grace.toSeconds.round} s after its flight")

  extension (loop: AnyLoop)
    def label: String = loop match
      case kind: LoopKind => kind.label
      case own: OwnLoop   => own.name
