import scala.xml.{Elem, Node}
import scala.xml.transform.{RewriteRule, RuleTransformer}

object Publishing {

  /** Whether this sbt was started to publish. */
  val isWanted: Boolean = sys.props.getOrElse("sun.java.command", "").contains("publish")

  /** A part's description without what its tests need: some of it is published nowhere. */
  def withoutTests(pom: Node): Node = new RuleTransformer(new RewriteRule {
    override def transform(node: Node): Seq[Node] = node match {
      case one: Elem if one.label == "dependency" && (one \ "scope").text == "test" => Nil
      case other                                                                    => other
    }
  }).transform(pom).head
}
