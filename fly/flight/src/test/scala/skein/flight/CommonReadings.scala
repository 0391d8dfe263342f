package skein.flight

import skein.record.{ReadingRow, Recording}
import skein.units.*

/** What is known of two vehicles at moments at which both were read. */
private[flight] object CommonReadings:
  /** Distance of the duel's two vehicles, m: mean of the last 10 s of a minute. */
  def distanceM(recording: Recording): Double =
    def of(vehicle: String) = recording.readings.filter(_.vehicle == vehicle)
    val (ours, theirs)      = (of("Pursuer"), of("Evader"))
    val from                = ours.head.state.validAt + Span.ofSeconds(50)
    val common              =
      for
        own <- ours if own.state.validAt >= from
        at = own.state.validAt
        other <- theirs.minByOption(read => math.abs(read.state.validAt.since(at).toNanos))
        if math.abs(other.state.validAt.since(at).toMillis) < 100
      yield own.state.value.positionNed.horizontalDistance(placeAt(other, at))
    common.sum / common.size

  private def placeAt(read: ReadingRow, at: Instant) =
    read.state.value.positionNed + read.state.value.velocityNed * at.since(read.state.validAt).toSeconds
