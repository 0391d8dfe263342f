package skein.airsim.wire

import scala.compiletime.{constValueTuple, summonAll}
import scala.deriving.Mirror
import upickle.core.{Abort, NoOpVisitor, ObjVisitor, StringVisitor, Visitor}
import upickle.default.{ReadWriter, SimpleReader}

/** Codec of a case class as a map with a key for each field. Keys may come in any order, unknown keys are
  * skipped, and a key may be missing if its field has a default. All fields are written but `skein_missing`,
  * which AirSim does not know, where it has its default.
  *
  * The compiler needs a fifth of the time that upickle's own derivation takes for the messages of this
  * package, which were the slowest files of the build.
  */
private[skein] trait Fields[A] extends ReadWriter[A]

private[skein] object Fields:
  private val missing = new Object

  inline def derived[A <: Product](using mirror: Mirror.ProductOf[A]): Fields[A] =
    of(
      mirror,
      constValueTuple[mirror.MirroredElemLabels],
      summonAll[Tuple.Map[mirror.MirroredElemTypes, ReadWriter]]
    )

  def of[A <: Product](mirror: Mirror.ProductOf[A], labels: Tuple, fields: Tuple): Fields[A] =
    val names    = labels.productIterator.map(_.toString).toArray
    val codecs   = fields.productIterator.map(_.asInstanceOf[ReadWriter[Any]]).toArray
    val defaults = defaultsOf(mirror, names.length)
    val extra    = names.indexOf("skein_missing")

    new SimpleReader[A] with Fields[A]:
      def expectedMsg = "expected dictionary"

      // RpcClient says where a nil is.
      override def visitNull(index: Int): A = null.asInstanceOf[A]

      override def visitObject(length: Int, jsonableKeys: Boolean, index: Int): ObjVisitor[Any, A] =
        new ObjVisitor[Any, A]:
          private val values = defaults.clone
          private var at     = -1

          def visitKey(index: Int)               = StringVisitor
          def visitKeyValue(key: Any)            = at = names.indexOf(key.toString)
          def subVisitor                         = if at < 0 then NoOpVisitor else codecs(at)
          def visitValue(value: Any, index: Int) = if at >= 0 then values(at) = value
          def visitEnd(index: Int)               =
            val absent = names.indices.filter(values(_) == missing).map(names(_))
            if absent.nonEmpty then throw Abort(s"missing keys in dictionary: ${absent.mkString(", ")}")
            mirror.fromProduct(Tuple.fromArray(values))

      def write0[V](out: Visitor[?, V], value: A): V =
        val left = if extra >= 0 && value.productElement(extra) == defaults(extra) then extra else -1
        val map  = out.visitObject(names.length - (if left >= 0 then 1 else 0), true, -1).narrow
        for i <- 0 until names.length do
          if i != left then
            map.visitKeyValue(map.visitKey(-1).visitString(names(i), -1))
            map.visitValue(codecs(i).write(map.subVisitor, value.productElement(i)), -1)
        map.visitEnd(-1)

  /** The compiler makes the mirror of a case class its companion, with a method for each default. */
  private def defaultsOf(companion: Any, size: Int): Array[Any] =
    val methods = companion.getClass.getMethods.map(method => method.getName -> method).toMap
    Array.tabulate(size): i =>
      methods.get(s"$$lessinit$$greater$$default$$${i + 1}").fold[Any](missing)(_.invoke(companion))
