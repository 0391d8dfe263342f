package skein.record

/** Skein's own control loops, with their labels. */
enum LoopKind(val label: String):
  case Paused     extends LoopKind("paused")
  case Sequential extends LoopKind("sequential")
  case Futures    extends LoopKind("futures")
  case Stream     extends LoopKind("stream")
  case Predictive extends LoopKind("predictive")
  case Plan       extends LoopKind("plan")

object LoopKind:
  def parse(label: String): Either[String, LoopKind] =
    values
      .find(_.label == label)
      .toRight(s"no loop '$label': expected one of ${values.map(_.label).mkString(", ")}")
