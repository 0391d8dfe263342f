package skein.flow

import org.apache.pekko.stream.stage.*
import org.apache.pekko.stream.{Attributes, FlowShape, Inlet, Outlet}
import skein.units.*

/** Emits elements at least an interval apart, each the newest at its emission. Unlike `buffer(1, dropHead)`
  * before `throttle`, which fetches an element and then lets it grow old for an interval, this stage chooses
  * only when it emits.
  *
  * Where something else keeps the period, such as the ticks of [[Sense]], half of the period is a good
  * interval: jitter of the arrivals then costs neither a turn nor freshness, and the delay of one turn is not
  * passed on to the next.
  *
  *   - '''Emits when''' an element is held, downstream demands, and the interval since the last emission has
  *     passed.
  *   - '''Backpressures when''' never; a newer element replaces the held one, which is reported.
  *   - '''Completes when''' upstream completes; an element still held is reported as replaced.
  *   - '''Cancels when''' downstream cancels.
  *
  * @param onReplaced called for every element that was never emitted
  */
final class Pace[A](interval: Span, clock: Clock)(onReplaced: A => Unit) extends GraphStage[FlowShape[A, A]]:
  private val in  = Inlet[A]("Pace.in")
  private val out = Outlet[A]("Pace.out")

  val shape: FlowShape[A, A] = FlowShape(in, out)

  def createLogic(attributes: Attributes): GraphStageLogic =
    new TimerGraphStageLogic(shape) with InHandler with OutHandler:
      private var held: Option[A] = None
      private var nextAt          = Instant.Epoch

      override def preStart(): Unit = pull(in)

      def onPush(): Unit =
        held.foreach(onReplaced)
        held = Some(grab(in))
        pull(in)
        emitWhenDue()

      def onPull(): Unit = emitWhenDue()

      override def onUpstreamFinish(): Unit =
        held.foreach(onReplaced)
        completeStage()

      override protected def onTimer(key: Any): Unit = emitWhenDue()

      private def emitWhenDue(): Unit =
        if isAvailable(out) then
          for element <- held do
            val now = clock.now()
            if now >= nextAt then
              held = None
              nextAt = now + interval
              push(out, element)
            else if !isTimerActive(Pace.Turn) then scheduleOnce(Pace.Turn, nextAt.since(now).toDuration)

      setHandlers(in, out, this)

object Pace:
  private case object Turn
