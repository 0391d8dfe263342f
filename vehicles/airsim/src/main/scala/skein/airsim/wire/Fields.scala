package skein.airsim.wire

import scala.compiletime.{constValueTuple, summonAll}
import scala.deriving.Mirror
import skein.pickle
import upickle.default.ReadWriter

/** Codec of a message. All fields are written but `skein_missing`, which AirSim does not know, where it has
  * its default.
  */
final private[skein] class Fields[A](mirror: Mirror.ProductOf[A], labels: Tuple, fields: Tuple)
    extends pickle.Fields[A](mirror, labels, fields, omits = _ == "skein_missing")

private[skein] object Fields:
  inline def derived[A](using mirror: Mirror.ProductOf[A]): Fields[A] =
    Fields(
      mirror,
      constValueTuple[mirror.MirroredElemLabels],
      summonAll[Tuple.Map[mirror.MirroredElemTypes, ReadWriter]]
    )
