//! The figures that the paper published: Tables 2 to 6 and 8, over ten trials with GPT-4o.

use coin_schemas::experiment::{Method, Metric, Spread};
use coin_schemas::household::UsageType;

/// A row: Subset Accuracy, Mean Jaccard, micro-averaged precision, recall and F1, each mean and standard deviation.
type Row = [(f64, f64); 5];

/// Tables 2 and 8: all things.
fn overall(method: Method) -> Option<Row> {
    Some(match method {
        Method::Actowl => [(0.674, 0.009), (0.674, 0.009), (1.0, 0.0), (0.529, 0.023), (0.691, 0.020)],
        Method::NlmapLlm => [(0.182, 0.043), (0.367, 0.043), (0.539, 0.033), (0.444, 0.039), (0.486, 0.034)],
        Method::LastUser => [(0.588, 0.0), (0.721, 0.0), (0.941, 0.0), (0.582, 0.0), (0.719, 0.0)],
        Method::Frequency => [(0.647, 0.0), (0.779, 0.0), (1.0, 0.0), (0.618, 0.0), (0.764, 0.0)],
        Method::CoinPaper => [(0.988, 0.028), (0.991, 0.023), (0.996, 0.012), (0.993, 0.018), (0.994, 0.014)],
        Method::NoQuestions => {
            [(0.574, 0.016), (0.752, 0.012), (0.888, 0.011), (0.675, 0.016), (0.766, 0.011)]
        }
        Method::NoBackground => [(0.985, 0.016), (0.990, 0.010), (0.982, 0.018), (1.0, 0.0), (0.991, 0.009)],
        Method::NoUsage => [(0.988, 0.028), (0.992, 0.017), (0.988, 0.027), (1.0, 0.0), (0.994, 0.014)],
        Method::Coin => return None,
    })
}

/// Tables 4 to 6. The standard deviation 1.170 of ActOwL on temporary sharing stands so in the paper; no share of
/// fifteen things can vary as much.
fn by_usage_type(method: Method, usage_type: UsageType) -> Option<Row> {
    use UsageType::{MultiUserSharing, SingleUser, TemporarySharing};
    Some(match (method, usage_type) {
        (Method::Actowl, SingleUser) => [(0.8, 0.0); 5],
        (Method::NlmapLlm, SingleUser) => {
            [(0.250, 0.053), (0.313, 0.066), (0.328, 0.067), (0.390, 0.088), (0.356, 0.075)]
        }
        (Method::LastUser | Method::Frequency, SingleUser) => [(1.0, 0.0); 5],
        (Method::CoinPaper, SingleUser) => [(0.980, 0.063); 5],
        (Method::Actowl, TemporarySharing) => {
            [(0.667, 1.170), (0.667, 1.170), (0.667, 1.170), (0.769, 0.0), (0.714, 0.0)]
        }
        (Method::NlmapLlm, TemporarySharing) => {
            [(0.133, 0.089), (0.304, 0.082), (0.420, 0.055), (0.422, 0.077), (0.420, 0.063)]
        }
        (Method::LastUser, TemporarySharing) => {
            [(0.600, 0.0), (0.700, 0.0), (0.867, 0.0), (0.591, 0.0), (0.703, 0.0)]
        }
        (Method::Frequency, TemporarySharing) => {
            [(0.733, 0.0), (0.833, 0.0), (1.0, 0.0), (0.682, 0.0), (0.811, 0.0)]
        }
        (Method::CoinPaper, TemporarySharing) => {
            [(0.987, 0.028), (0.993, 0.014), (1.0, 0.0), (0.991, 0.019), (0.995, 0.010)]
        }
        (Method::Actowl, MultiUserSharing) => {
            [(0.878, 0.035), (0.878, 0.035), (1.0, 0.0), (0.560, 0.126), (0.708, 0.132)]
        }
        (Method::NlmapLlm, MultiUserSharing) => {
            [(0.189, 0.075), (0.531, 0.030), (0.992, 0.026), (0.487, 0.027), (0.653, 0.026)]
        }
        (Method::LastUser | Method::Frequency, MultiUserSharing) => {
            [(0.111, 0.0), (0.444, 0.0), (1.0, 0.0), (0.391, 0.0), (0.563, 0.0)]
        }
        (Method::CoinPaper, MultiUserSharing) => [(1.0, 0.0); 5],
        _ => return None,
    })
}

/// What the paper has for a metric of a method; `None` where it has nothing.
pub(super) fn metric(method: Method, usage_type: Option<UsageType>, metric: Metric) -> Option<Spread> {
    let row = match usage_type {
        None => overall(method),
        Some(usage_type) => by_usage_type(method, usage_type),
    }?;
    let (mean, sd) = match metric {
        Metric::SubsetAccuracy => row[0],
        Metric::MeanJaccard => row[1],
        Metric::MicroPrecision => row[2],
        Metric::MicroRecall => row[3],
        Metric::MicroF1 => row[4],
    };
    Some(Spread { mean, sd })
}

/// The published number of questions.
pub(super) fn questions(method: Method) -> Option<Spread> {
    let (mean, sd) = match method {
        Method::Actowl => (19.7, 0.949),
        Method::CoinPaper => (28.4, 1.578),
        Method::NoBackground => (33.3, 0.483),
        Method::NoUsage => (32.5, 1.179),
        _ => return None,
    };
    Some(Spread { mean, sd })
}

/// The published number of tokens.
pub(super) fn tokens(method: Method) -> Option<Spread> {
    let (mean, sd) = match method {
        Method::Actowl => (326_900.0, 3_479.0),
        Method::CoinPaper => (511_706.0, 6_862.0),
        _ => return None,
    };
    Some(Spread { mean, sd })
}

/// The published inference time, in seconds.
pub(super) fn seconds(method: Method) -> Option<Spread> {
    let (mean, sd) = match method {
        Method::Actowl => (1530.144, 125.125),
        Method::CoinPaper => (625.831, 27.996),
        _ => return None,
    };
    Some(Spread { mean, sd })
}
