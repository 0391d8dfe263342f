package skein.flow

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.Flow
import skein.fusion.{Belief, Fusion, FusionSettings, Measurement}

/** Joins what is measured of vehicles, in the order in which it was true. */
object Fuse:

  /** What is believed of a vehicle after each measurement of it. A measurement enters at its own moment, though newer ones
    * have come: a detection at the time its image was exposed, not when its recognition ended. The belief is of the newest
    * measurement's moment; [[skein.fusion.Belief.carriedTo]] carries it on.
    *
    * '''Emits when''' a measurement arrives that is not older than what is remembered. '''Backpressures when''' downstream
    * backpressures. '''Completes when''' upstream completes. '''Cancels when''' downstream cancels.
    *
    * @tparam K
    *   of which vehicle; as many as there are keys are remembered
    * @param onTooOld
    *   told of every measurement that is older than what is remembered, and is not joined
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
