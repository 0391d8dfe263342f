/** Whether this sbt was started to publish. */
object Publishing {
  val isWanted: Boolean = sys.props.getOrElse("sun.java.command", "").contains("publish")
}
