package skein.flow

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.Flow
import skein.fusion.{Belief, Fusion, FusionSettings, Measurement}

/** Estimates vehicles' states from measurements, in the order of their valid times. */
object Fuse:

  /** Emits a vehicle's estimate after each measurement of it. A measurement counts at its valid time, even if
    * newer ones were received before it: a detection at the exposure of its image, not when its recognition
    * ended. The estimate is of the newest valid time; [[skein.fusion.Belief.carriedTo]] predicts it further.
    *
    * '''Emits when''' a measurement arrives that is not too old. '''Backpressures when''' downstream
    * backpressures. '''Completes when''' upstream completes. '''Cancels when''' downstream cancels.
    *
    * @tparam K identifies the vehicle; a filter is kept for each
    * @param onTooOld called for every measurement older than all that are kept; it is discarded
    */
  def apply[K](settings: FusionSettings = FusionSettings())(
      onTooOld: (K, Measurement) => Unit
  ): Flow[(K, Measurement), (K, Belief), NotUsed] =
    Flow[(K, Measurement)]
      .statefulMap(() => Map.empty[K, Fusion])(
        { case (fusions, (key, measured)) =>
          fusions.getOrElse(key, Fusion(settings)).including(measured) match
            case Some(fusion) => (fusions.updated(key, fusion), fusion.belief.map((key, _)))
            case None         =>
              onTooOld(key, measured)
              (fusions, None)
        },
        _ => None
      )
      .collect { case Some(believed) => believed }
