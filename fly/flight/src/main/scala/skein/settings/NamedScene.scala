package skein.settings

import skein.record.ParameterRow
import skein.scene.{Scene, SceneFile}

/** A scene with its name.
  *
  * @param name name of a built-in scene, or a file's path
  * @param text the file's text; absent for a built-in scene
  */
final case class NamedScene private (name: String, text: Option[String], scene: Scene):
  def isEmpty: Boolean = scene.objects.isEmpty

object NamedScene:
  val Empty: NamedScene = NamedScene("empty", None, Scene.Empty)

  def read(name: String): Either[String, NamedScene] = shipped(name).map(Right(_)).getOrElse:
    for
      text <- TextFile.read(name).left.map(error =>
        s"expected ${SceneFile.Names.mkString(", ")} or a file, got '$name': $error"
      )
      read <- ofText(name, text)
    yield read

  def shipped(name: String): Option[NamedScene] = SceneFile.named(name).map(NamedScene(name, None, _))

  /** The parameters of a recording: none for the empty scene; for a scene from a file, its whole text. */
  def recorded(flown: NamedScene): Seq[ParameterRow] =
    if flown.name == Empty.name then Nil
    else ParameterRow(Name, flown.name) +: flown.text.toSeq.map(ParameterRow(Text, _))

  /** Reads the scene of a recording.
    *
    * @param parameters the recording's parameters, keyed by name
    */
  def ofRecording(parameters: Map[String, String]): Either[String, NamedScene] =
    (parameters.get(Name), parameters.get(Text)) match
      case (None, _)                => Right(Empty)
      case (Some(name), Some(text)) => ofText(name, text)
      case (Some(name), None)       => shipped(name).toRight(s"its parameter '$Name': no scene '$name' ships")

  private def ofText(name: String, text: String): Either[String, NamedScene] =
    SceneFile
      .parse(text, name)
      .map(NamedScene(name, Some(text), _))
      .left
      .map(wrong => ConfigMistakes.oneLine(wrong.message))

  private val Name = "scene"
  private val Text = "scene.text"
