"""All commands as messages. Written by docs/make_remote_schema.py: change it there."""

from studio.remote.commands.act import (
    Calibrate,
    ChooseScene,
    Configure,
    ForgetCalibration,
    LetGo,
    Record,
    RecordAgain,
    Stop,
    Watch,
)
from studio.remote.commands.compare import (
    ForgetKept,
    KeepToCompare,
    PlaceBlock,
    PlaceStart,
    PutBlockBack,
    ShowLeg,
)
from studio.remote.commands.drive import BeginDriving, SetJointTarget
from studio.remote.commands.export import CancelExport, Export, OpenSession
from studio.remote.commands.learn import (
    CancelWork,
    ChooseLearner,
    Guess,
    ResumeCurve,
    RevealBlocks,
    Train,
    TryOut,
)
from studio.remote.commands.link import (
    ConnectLink,
    DisableLink,
    DisconnectLink,
    EnableLink,
    SetLinkSpeed,
    StartLink,
    StopLink,
)
from studio.remote.commands.parts import Calibration, Choices, HandOptions, LearnerSettings
from studio.remote.commands.source import (
    CancelReading,
    DragElbow,
    DragHand,
    FollowBody,
    PuppetHome,
    ReleaseElbow,
    Sign,
    UseDemonstrator,
    UseFile,
    UseLive,
    UsePuppet,
)
from studio.remote.commands.teach import (
    AddFrom,
    BeginTake,
    Choose,
    DeleteForGood,
    EndTake,
    Include,
    OpenRecording,
    Remove,
    Rename,
    Restore,
    Trim,
)
from studio.remote.commands.timeline import (
    PlayDemonstration,
    PlayReproduction,
    Scrub,
    SetLoop,
    SetSpeed,
    StepBy,
    TogglePlay,
)

Command = (
    AddFrom
    | BeginDriving
    | BeginTake
    | Calibrate
    | CancelExport
    | CancelReading
    | CancelWork
    | Choose
    | ChooseLearner
    | ChooseScene
    | Configure
    | ConnectLink
    | DeleteForGood
    | DisableLink
    | DisconnectLink
    | DragElbow
    | DragHand
    | EnableLink
    | EndTake
    | Export
    | FollowBody
    | ForgetCalibration
    | ForgetKept
    | Guess
    | Include
    | KeepToCompare
    | LetGo
    | OpenRecording
    | OpenSession
    | PlaceBlock
    | PlaceStart
    | PlayDemonstration
    | PlayReproduction
    | PuppetHome
    | PutBlockBack
    | Record
    | RecordAgain
    | ReleaseElbow
    | Remove
    | Rename
    | Restore
    | ResumeCurve
    | RevealBlocks
    | Scrub
    | SetJointTarget
    | SetLinkSpeed
    | SetLoop
    | SetSpeed
    | ShowLeg
    | Sign
    | StartLink
    | StepBy
    | Stop
    | StopLink
    | TogglePlay
    | Train
    | Trim
    | TryOut
    | UseDemonstrator
    | UseFile
    | UseLive
    | UsePuppet
    | Watch
)

__all__ = [
    "AddFrom",
    "BeginDriving",
    "BeginTake",
    "Calibrate",
    "Calibration",
    "CancelExport",
    "CancelReading",
    "CancelWork",
    "Choices",
    "Choose",
    "ChooseLearner",
    "ChooseScene",
    "Command",
    "Configure",
    "ConnectLink",
    "DeleteForGood",
    "DisableLink",
    "DisconnectLink",
    "DragElbow",
    "DragHand",
    "EnableLink",
    "EndTake",
    "Export",
    "FollowBody",
    "ForgetCalibration",
    "ForgetKept",
    "Guess",
    "HandOptions",
    "Include",
    "KeepToCompare",
    "LearnerSettings",
    "LetGo",
    "OpenRecording",
    "OpenSession",
    "PlaceBlock",
    "PlaceStart",
    "PlayDemonstration",
    "PlayReproduction",
    "PuppetHome",
    "PutBlockBack",
    "Record",
    "RecordAgain",
    "ReleaseElbow",
    "Remove",
    "Rename",
    "Restore",
    "ResumeCurve",
    "RevealBlocks",
    "Scrub",
    "SetJointTarget",
    "SetLinkSpeed",
    "SetLoop",
    "SetSpeed",
    "ShowLeg",
    "Sign",
    "StartLink",
    "StepBy",
    "Stop",
    "StopLink",
    "TogglePlay",
    "Train",
    "Trim",
    "TryOut",
    "UseDemonstrator",
    "UseFile",
    "UseLive",
    "UsePuppet",
    "Watch",
]
