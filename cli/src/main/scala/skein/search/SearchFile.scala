package skein.search

import java.nio.file.Path
import skein.optimise.{CmaEs, Course, Scored, SearchState, RunningStats}
import upickle.default.{ReadWriter, readwriter, writeJs, read as readJson, write as writeJson}

/** A search as it stands on disk: the question, and the state it has come to. */
final case class SearchFile(version: Int, question: SearchFile.Question, state: SearchState)

object SearchFile:
  val Name           = "search.json"
  val Version        = 2
  private val onDisk = StateFile(Name, Version, "a search")

  type Question = SearchQuestion | TeamQuestion

  given ReadWriter[RunningStats]        = ReadWriter.derived
  private given ReadWriter[Scored]      = ReadWriter.derived
  private given ReadWriter[CmaEs.State] = ReadWriter.derived
  private given ReadWriter[Course]      = ReadWriter.derived
  private given ReadWriter[SearchState] = ReadWriter.derived
  given ReadWriter[Question]            = readwriter[ujson.Value].bimap(
    {
      case duel: SearchQuestion => writeJs(duel)
      case team: TeamQuestion   => writeJs(team)
    },
    json =>
      if json.obj.contains("scenario") then readJson[TeamQuestion](json) else readJson[SearchQuestion](json)
  )
  private given ReadWriter[SearchFile] = ReadWriter.derived

  def json(file: SearchFile): String = onDisk.sealing(writeJson(file))

  def parse(text: String): Either[String, SearchFile] = onDisk.opened(text).flatMap(understood)

  /** Reads `search.json` of a folder.
    *
    * @return
    *   or why it cannot be gone on with
    */
  def read(folder: Path): Either[String, SearchFile] =
    onDisk.read(folder).flatMap(understood(_).left.map(mistake => s"${folder.resolve(Name)}: $mistake"))

  /** Replaces `search.json` of a folder, so that whatever happens there is the old one or the new one. */
  def write(folder: Path, file: SearchFile): Either[String, Unit] = onDisk.write(folder, writeJson(file))

  private def understood(json: String): Either[String, SearchFile] =
    try Right(readJson[SearchFile](json))
    catch case mistake: Exception => Left(s"expected the state of a search, came: ${mistake.getMessage}")
