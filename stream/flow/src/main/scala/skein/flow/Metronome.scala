package skein.flow

import org.apache.pekko.stream.stage.*
import org.apache.pekko.stream.{Attributes, Outlet, SourceShape}
import skein.units.*

/** Ticks at `first` and every `period` after it, by the clock: sources with equal `first` stay in phase,
  * however long each took to start, and never drift.
  *
  *   - '''Emits when''' a tick is due and downstream demands. The element is the number of ticks due since
  *     the last element: 1 unless downstream was slow. Ticks that were due before the start are left out.
  *   - '''Backpressures when''' never; ticks add up.
  *   - '''Completes when''' never.
  *   - '''Cancels when''' downstream cancels.
  */
final class Metronome(first: Instant, period: Span, clock: Clock) extends GraphStage[SourceShape[Int]]:
  require(period > Span.Zero, "the period must be positive")

  private val out = Outlet[Int]("Metronome.out")

  val shape: SourceShape[Int] = SourceShape(out)

  def createLogic(attributes: Attributes): GraphStageLogic =
    new TimerGraphStageLogic(shape) with OutHandler:
      private var next = first
      private var due  = 0

      override def preStart(): Unit =
        val late = clock.now().since(first)
        if late > Span.Zero then
          next = first + period * ((late.toNanos + period.toNanos - 1) / period.toNanos)
        schedule()

      def onPull(): Unit = emit()

      override protected def onTimer(key: Any): Unit =
        val now = clock.now()
        while next <= now do
          due += 1
          next = next + period
        schedule()
        emit()

      private def schedule(): Unit =
        scheduleOnce(Metronome.Tick, next.since(clock.now()).max(Span.Zero).toDuration)

      private def emit(): Unit = if due > 0 && isAvailable(out) then
        val ticks = due
        due = 0
        push(out, ticks)

      setHandler(out, this)

object Metronome:
  private case object Tick
